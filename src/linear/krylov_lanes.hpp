// Differences between one vector and several.
#pragma once

#include "linear/dilu.hpp"

#include <algorithm>

namespace grainlaw::core {

template <class Entry>
struct lanes_of;

template <class Entry>
inline constexpr bool in_single = sizeof(Entry) == Dilu::width * sizeof(float);

template <class Real>
struct lanes_of<BlockColumn<8, Real>> {
  static constexpr std::size_t entries = 1;  // per node
  static constexpr std::size_t shadows = 8;  // numbers of a shadow per entry
  static void reduce(double* sums) {
    double total = 0;
    for (std::size_t l = 0; l < Dilu::width; ++l) total += sums[l];
    std::fill_n(sums, Dilu::width, total);
  }
  static void find_largest(double* values) {
    std::fill_n(values, Dilu::width, *std::max_element(values, values + Dilu::width));
  }
};

template <class Real>
struct lanes_of<Together<8, Real>> {
  static constexpr std::size_t entries = Dilu::size;
  static constexpr std::size_t shadows = 1;
  static void reduce(double* /*sums*/) {}
  static void find_largest(double* /*values*/) {}
};

}  // namespace grainlaw::core
