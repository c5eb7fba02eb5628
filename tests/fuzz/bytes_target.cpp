// Any bytes as a saved state: the first chooses the material; the rest is loaded as it is, and again
// with the header and the checksum that make it this material's.
#include "support.hpp"

#include <grainlaw/grainlaw.hpp>

#include <xxhash.h>

#include <cmath>
#include <vector>

namespace {

using grainlaw::Material;
using grainlaw::State;

constexpr std::size_t header = 24,
                      checksum = 8;  // of serialise.cpp: up to the fingerprint; the end

const std::vector<Material>& materials() {
  static const std::vector<Material> all = [] {
    std::vector<Material> made;
    for (const std::string& text :
         {fuzz::lattice(fuzz::frictional), fuzz::lattice(fuzz::bonded), fuzz::lattice(fuzz::hertz),
          fuzz::lattice(fuzz::frictional, "boundary = { type = 'frame-p' }\n"),
          fuzz::lattice(fuzz::frictional, "solver = { contacts_lost = 'stress_free' }\n")})
      made.push_back(Material::parse(text, "/"));
    return made;
  }();
  return all;
}

void load(State& state, const std::vector<std::byte>& bytes) {
  const auto before = state.save();
  const grainlaw_status status = grainlaw_state_load(state.get(), bytes.data(), bytes.size());
  EXPECT(status == GRAINLAW_OK || status == GRAINLAW_BAD_BYTES ||
         status == GRAINLAW_WRONG_VERSION || status == GRAINLAW_WRONG_MATERIAL ||
         (bytes.data() == nullptr && status == GRAINLAW_NULL_POINTER));
  const auto after = state.save();
  if (status != GRAINLAW_OK) {
    EXPECT(after == before);
    return;
  }
  // What was loaded can be loaded again, measured and deformed.
  EXPECT(grainlaw_state_load(state.get(), after.data(), after.size()) == GRAINLAW_OK);
  EXPECT(state.save() == after);
  (void)state.measure(GRAINLAW_COORDINATION);
  auto F = state.measure(GRAINLAW_DEFORMATION_GRADIENT);
  F[1] += 1e-4;
  double P[4] = {0, 0, 0, 0}, A[16];
  const auto answer =
      grainlaw_evaluate(state.get(), F.data(), GRAINLAW_WANT_TANGENT_EXACT, P, A, nullptr);
  EXPECT(answer >= 0);
  for (const double p : P) EXPECT(std::isfinite(p));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Material& material = materials()[data[0] % materials().size()];
  const auto* begin = reinterpret_cast<const std::byte*>(data + 1);
  std::vector<std::byte> bytes(begin, begin + size - 1);
  State state(material);
  const auto good = state.save();
  load(state, bytes);
  if (bytes.size() < header + checksum) return 0;

  // The number of contacts, in bytes 12 to 15, stays as it was found.
  std::memcpy(bytes.data(), good.data(), 12);
  std::memcpy(bytes.data() + 16, good.data() + 16, header - 16);
  const std::uint64_t sum = XXH3_64bits(bytes.data(), bytes.size() - checksum);
  for (std::size_t k = 0; k < checksum; ++k)
    bytes[bytes.size() - checksum + k] = static_cast<std::byte>(sum >> (8 * k));
  load(state, bytes);
  return 0;
}
