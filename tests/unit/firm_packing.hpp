// A packing in which rounding decides nothing.
#pragma once

#include "support.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace grainlaw::core::test {

// Every disc is held: by three contacts or more, none of them marginal. A disc that rattles has no
// equilibrium of its own and ends where the way leads it.
inline bool nothing_rattles(const Packing& packing) {
  constexpr double marginal = 1e-3;  // of the mean normal force
  const State state(make_material(describe(packing, smooth_law())));
  const auto views = contact_views(state.material().problem(), state.committed());
  std::vector<int> held(packing.size(), 0);
  double mean = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& view : views) {
    ++held[static_cast<std::size_t>(view.i)];
    ++held[static_cast<std::size_t>(view.j)];
    mean += view.normal_force / static_cast<double>(views.size());
    least = std::min(least, view.normal_force);
  }
  return least > marginal * mean && *std::min_element(held.begin(), held.end()) >= 3;
}

// Compressed until the discs overlap by some percent, which leaves no room to rattle in nearly every
// packing; the first of them.
inline Packing firm_packing() {
  GeneratorOptions options;
  options.count = 80;
  options.pressure = 2e6;
  for (options.seed = 1; options.seed < 20; ++options.seed) {
    Packing packing = consolidate(options, smooth_law());
    if (nothing_rattles(packing)) return packing;
  }
  ADD_FAILURE() << "no packing without rattlers";
  return small_packing();
}

}  // namespace grainlaw::core::test
