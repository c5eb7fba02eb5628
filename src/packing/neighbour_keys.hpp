// Integer keys of (particle, shift), and loops over boxes of bins.
#pragma once

#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace grainlaw::core::neighbour {

// Key of (particle, shift): the particle in the upper half, then the biased shifts. Comparing keys
// compares (particle, shift), and adding a shift is one addition.
template <int D>
struct Key {
  static constexpr int bits = 32 / D;  // bits per component of a shift
  static constexpr std::int64_t bias = std::int64_t{1} << (bits - 1);
  static constexpr std::int64_t largest_shift = bias - 1;
  static constexpr std::uint64_t mask = (std::uint64_t{1} << bits) - 1;

  template <class Counts>
  static std::uint64_t of_shift(const Counts& counts) {
    std::uint64_t key = 0;
    for (std::size_t k = 0; k < D; ++k) {
      key = (key << bits) + static_cast<std::uint64_t>(static_cast<std::int64_t>(counts[k]));
    }
    return key;
  }
  static std::uint64_t of_particle(std::size_t particle) {
    std::array<std::int64_t, static_cast<std::size_t>(D)> biases;
    biases.fill(bias);
    return (static_cast<std::uint64_t>(particle) << 32) + of_shift(biases);
  }
  static NeighbourPair<D> pair(std::size_t i, std::uint64_t key) {
    NeighbourPair<D> result{static_cast<std::int32_t>(i), static_cast<std::int32_t>(key >> 32), {}};
    for (std::size_t k = D; k-- > 0; key >>= bits) {
      result.shift[k] = static_cast<std::int16_t>(static_cast<std::int64_t>(key & mask) - bias);
    }
    return result;
  }
};

// Calls visit(counts) for all counts from first to last, the first component fastest.
template <std::size_t D, class Visit>
void for_box(const std::array<std::int32_t, D>& first, const std::array<std::int32_t, D>& last,
             Visit&& visit) {
  std::array<std::int32_t, D> at = first;
  const auto plane = [&] {
    for (at[1] = first[1]; at[1] <= last[1]; ++at[1]) {
      for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) visit(at);
    }
  };
  if constexpr (D == 2) {
    plane();
  } else {
    for (at[2] = first[2]; at[2] <= last[2]; ++at[2]) plane();
  }
}

}  // namespace grainlaw::core::neighbour
