// Any text as a material: an answer or a message that says what is wrong.
#include "support.hpp"

#include "base/error.hpp"
#include "material/material_file.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
#include <cmath>

namespace {

// Whether its packing is made within milliseconds.
bool is_small(const std::string& text) {
  using grainlaw::core::GeneratorKind;
  try {
    const auto description = grainlaw::core::parse_material(text, "/nowhere", "fuzz");
    const auto& generator = description.generator;
    const bool regular = generator && (generator->kind == GeneratorKind::square ||
                                       generator->kind == GeneratorKind::hexagonal);
    // Stresses that no packing of these carries take seconds to be told under sanitizers.
    constexpr double bearable = 1e7;
    const bool light = std::ranges::all_of(description.boundary.stress, [](const auto& stress) {
      return std::abs(stress.value_or(0)) <= bearable;
    });
    return regular && light && generator->columns * generator->rows <= 20 &&
           description.solver.method == grainlaw::core::Method::direct;
  } catch (const grainlaw::core::Error& error) {
    EXPECT(error.status < 0 && error.what()[0] != '\0');
    return false;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (text.find('\0') != std::string::npos || fuzz::asks_for_much(text)) return -1;
  if (!is_small(text)) return 0;

  char message[300];
  std::memset(message, 'x', sizeof message);
  grainlaw_material* material = nullptr;
  const grainlaw_status status =
      grainlaw_material_parse(text.c_str(), "/nowhere", &material, message, sizeof message);
  EXPECT(std::memchr(message, '\0', sizeof message) != nullptr);
  EXPECT((status == GRAINLAW_OK) == (material != nullptr));
  EXPECT((status == GRAINLAW_OK) == (message[0] == '\0'));
  EXPECT(status != GRAINLAW_INTERNAL_FAULT && status != GRAINLAW_NOT_FINITE);
  if (status != GRAINLAW_OK) return 0;

  grainlaw_state* state = nullptr;
  EXPECT(grainlaw_state_create(material, &state) == GRAINLAW_OK);
  const double F[4] = {1, 1e-4, 0, 0.9995};
  double P[4], A[16];
  EXPECT(grainlaw_evaluate(state, F, GRAINLAW_WANT_TANGENT_EXACT, P, A, nullptr) >= 0);
  grainlaw_state_destroy(state);
  grainlaw_material_destroy(material);
  return 0;
}
