// Derivatives by the components of F, several in one register.
#pragma once

#include "linear/columns.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <array>
#include <cstddef>

namespace grainlaw::core {

// The derivatives of one number by the components of F, one in every lane.
template <int D>
using ByDeformation = Together<Dimension<D>::lanes>;

// Of F.
template <int D>
using DeformationChange = std::array<ByDeformation<D>, squared<D>>;

// The changes of F that the lanes stand for: in the plane its components (row-major); in space the six
// of U in F = U F_n, of the committed F_n (11, 22, 33, 23, 13, 12), since a rotation changes nothing.
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

// Of a contact that touches: force on j, branch, and the spring's force.
template <int D>
struct ContactChange {
  std::array<ByDeformation<D>, static_cast<std::size_t>(D)> force, branch;
  std::array<ByDeformation<D>, Dimension<D>::tangents> tangential_force;
};

// Of what the history of listed contacts starts from: null, none.
template <int D>
struct HistoryChange;

// What the history of contacts starts from, kept from one sub-increment to the next.
template <int D>
class HistoryDerivatives;

}  // namespace grainlaw::core
