// Layout, little-endian: u32 1 exists, 2 loose, 4 advanced; where it exists
//   u64 size  the bytes of a state whose committed configuration it is;
//   u64 slopes  f32 each.
#include "state/serialise_trial.hpp"

#include "base/error.hpp"
#include "base/saved_bytes.hpp"
#include "state/state.hpp"
#include "state/trial_slopes.hpp"

#include <cstdint>
#include <utility>

namespace grainlaw::core {

namespace {

constexpr std::uint32_t bit_exists = 1, bit_loose = 2, bit_advanced = 4;

void require(bool condition) {
  if (!condition)
    throw Error(GRAINLAW_BAD_BYTES, "saved trial: its length does not fit its content");
}

// Reads a number of items of a size each, of which there have to be so many bytes.
std::size_t read_count(ByteReader& in, std::size_t size) {
  require(in.left() >= sizeof(std::uint64_t));
  const auto count = in.get<std::uint64_t>();
  require(count <= in.left() / size);
  return count;
}

}  // namespace

template <int D>
bool State<D>::keeps_trial(bool evaluated) const {
  return has_trial_ && (evaluated || material_->solver.start == Start::trial);
}

template <int D>
std::size_t State<D>::saved_trial_size(bool evaluated) const {
  if (!keeps_trial(evaluated)) return sizeof(std::uint32_t);
  return sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t) + saved_size(*material_, trial_) +
         sizeof(float) * trial_slopes_.size();
}

template <int D>
void State<D>::save_trial(bool evaluated, std::span<std::byte> bytes) const {
  ByteWriter out(bytes);
  if (!keeps_trial(evaluated)) return out.put(std::uint32_t{0});
  out.put(bit_exists + (trial_loose_ ? bit_loose : 0) + (trial_advanced_ ? bit_advanced : 0));
  const std::size_t size = saved_size(*material_, trial_);
  out.put(std::uint64_t{size});
  save_configuration(*material_, trial_, out.skip(size));
  out.put(std::uint64_t{trial_slopes_.size()});
  for (const float slope : trial_slopes_) out.put(slope);
}

template <int D>
SavedTrialOf<D> State<D>::read_trial(std::span<const std::byte> bytes) const {
  ByteReader in(bytes);
  require(in.left() >= sizeof(std::uint32_t));
  const auto bits = in.get<std::uint32_t>();
  SavedTrialOf<D> saved;
  saved.exists = (bits & bit_exists) != 0;
  saved.loose = (bits & bit_loose) != 0;
  saved.advanced = (bits & bit_advanced) != 0;
  if (saved.exists) {
    saved.configuration = load_configuration(*material_, in.take(read_count(in, 1))).committed;
    const std::size_t slopes = read_count(in, sizeof(float));
    require(slopes == 0 || slopes == number_of_slopes<D>(material_->problem()));
    saved.slopes.resize(slopes);
    for (float& slope : saved.slopes) slope = in.get<float>();
  }
  require(in.left() == 0);
  return saved;
}

template <int D>
void State<D>::restore(SavedTrialOf<D> saved) noexcept {
  has_trial_ = saved.exists;
  if (!has_trial_) return;
  trial_ = std::move(saved.configuration);
  trial_slopes_ = std::move(saved.slopes);
  trial_loose_ = saved.loose;
  trial_advanced_ = saved.advanced;
}

#define GRAINLAW_FOR(D)                                                            \
  template bool State<D>::keeps_trial(bool) const;                                 \
  template std::size_t State<D>::saved_trial_size(bool) const;                     \
  template void State<D>::save_trial(bool, std::span<std::byte>) const;            \
  template SavedTrialOf<D> State<D>::read_trial(std::span<const std::byte>) const; \
  template void State<D>::restore(SavedTrialOf<D>) noexcept;
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
