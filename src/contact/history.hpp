// What a touching contact remembers.
#pragma once

#include "math/dimension.hpp"

#include <array>
#include <cstdint>

namespace grainlaw::core {

// Branch l = x_j - x_i + F H0 shift.
template <int D>
struct ContactHistory {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::array<std::int16_t, static_cast<std::size_t>(D)> shift{};
  bool sliding = false;  // at the friction limit
  bool bonded = false;
  // On j: of discs along the branch normal turned by +90 degrees, of spheres a vector [N].
  std::array<double, Dimension<D>::tangents> tangential_force{};
};

}  // namespace grainlaw::core
