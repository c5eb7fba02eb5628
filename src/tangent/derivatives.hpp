// Derivatives by the components of F, several in one register.
#pragma once

#include "linear/columns.hpp"
#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <array>
#include <cstddef>

namespace grainlaw {

// The derivatives of one number by the components of F, one in every lane.
template <int D>
using ByDeformation = Together<Dimension<D>::lanes>;

// Of F.
template <int D>
using DeformationChange = std::array<ByDeformation<D>, squared<D>>;

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

}  // namespace grainlaw
