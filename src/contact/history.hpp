// History of a touching contact.
#pragma once

#include "math/dimension.hpp"

#include <array>
#include <cstdint>

namespace grainlaw::core {

// Contact with the branch l = x_j - x_i + F H0 shift. @formula branch
template <int D>
struct ContactHistory {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::array<std::int16_t, static_cast<std::size_t>(D)> shift{};
  bool sliding = false;  // at the friction limit
  bool bonded = false;
  // Force on j [N]: for discs along the normal rotated by +90 degrees, for spheres a vector.
  std::array<double, Dimension<D>::tangents> tangential_force{};
};

}  // namespace grainlaw::core
