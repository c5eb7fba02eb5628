// Stiffness of discs and frames; included by stiffness.hpp.
#pragma once

#include "tangent/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainlaw::core {

template <>
void Stiffness<2>::add_contacts();
template <>
void Stiffness<2>::add_moments();
template <>
void Stiffness<2>::link_anchors(const Increment<2>& increment);
template <>
void Stiffness<2>::add_anchors(const Increment<2>& increment);
template <>
bool Stiffness<2>::solve_step(Increment<2>& increment, std::span<const double> b, double forcing,
                              std::span<double> x);

// Distance between anchors among the nodes of an average: enough anchors to regularise the frame,
// few enough to link.
inline std::size_t anchor_stride(const AverageConstraint& average) {
  constexpr std::size_t anchors = 8;
  return std::max<std::size_t>(1, average.node.size() / anchors);
}

// Mean of the anchors' rows, which is subtracted so that anchors do not resist a translation.
inline std::array<double, 2> anchor_mean(const AverageConstraint& average) {
  std::array<double, 2> mean{};
  double count = 0;
  for (std::size_t k = 0; k < average.node.size(); k += anchor_stride(average), ++count) {
    mean[0] += average.row[k][0];
    mean[1] += average.row[k][1];
  }
  return {mean[0] / count, mean[1] / count};
}

}  // namespace grainlaw::core
