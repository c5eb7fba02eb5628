// Derivatives by the components of F, several per register.
#pragma once

#include "linear/columns.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <array>
#include <cstddef>

namespace grainlaw::core {

// Derivatives of one number by the components of F, one per lane.
template <int D>
using ByDeformation = Together<Dimension<D>::lanes>;

// Derivatives of F itself.
template <int D>
using DeformationChange = std::array<ByDeformation<D>, squared<D>>;

// Changes of F that the lanes stand for. In the plane: its components, row-major. In space: the six
// components of U in F = U F_n (11, 22, 33, 23, 13, 12), with committed F_n, since a rotation
// changes nothing.
template <int D>
DeformationChange<D> directions(const Tensor<D>& committed);
template <>
inline DeformationChange<2> directions<2>(const Tensor<2>& /*committed*/) {
  DeformationChange<2> change{};
  for (std::size_t k = 0; k < 4; ++k) change[k].lane[k] = 1;
  return change;
}

constexpr std::array<std::array<std::size_t, 2>, 6> stretch_of_lane{
    {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
template <>
inline DeformationChange<3> directions<3>(const Tensor<3>& committed) {
  DeformationChange<3> change{};
  for (std::size_t lane = 0; lane < stretch_of_lane.size(); ++lane) {
    const auto [a, b] = stretch_of_lane[lane];
    for (std::size_t l = 0; l < 3; ++l) {
      change[3 * a + l].lane[lane] = committed[3 * b + l];
      change[3 * b + l].lane[lane] = committed[3 * a + l];
    }
  }
  return change;
}

// The change of F as factors of the lanes, to first order.
template <int D>
ByDeformation<D> in_directions(const Tensor<D>& change, const Tensor<D>& committed);
template <>
inline ByDeformation<2> in_directions<2>(const Tensor<2>& change, const Tensor<2>& /*committed*/) {
  return {{change[0], change[1], change[2], change[3]}};
}
template <>
inline ByDeformation<3> in_directions<3>(const Tensor<3>& change, const Tensor<3>& committed) {
  const Tensor<3> stretch = product<3>(change, inverse<3>(committed));
  ByDeformation<3> factors;
  for (std::size_t lane = 0; lane < stretch_of_lane.size(); ++lane) {
    const auto [a, b] = stretch_of_lane[lane];
    factors.lane[lane] = 0.5 * (stretch[3 * a + b] + stretch[3 * b + a]);
  }
  return factors;
}

// Change of a touching contact: force on j, branch, and force of the tangential spring.
template <int D>
struct ContactChange {
  std::array<ByDeformation<D>, static_cast<std::size_t>(D)> force, branch;
  std::array<ByDeformation<D>, Dimension<D>::tangents> tangential_force;
};

// Change of the start of the history, for the listed contacts; null: no change.
template <int D>
struct HistoryChange;

// Derivatives of the start of the history, carried from one sub-increment to the next.
// @formula sensitivity
template <int D>
class HistoryDerivatives;

}  // namespace grainlaw::core
