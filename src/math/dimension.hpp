// Sizes that depend on the number of dimensions.
#pragma once

#include <cstddef>

namespace grainlaw::core {

template <int D>
struct Dimension {
  static_assert(D == 2 || D == 3);
  static constexpr std::size_t spins = D == 2 ? 1 : 3;  // components of a rotation
  static constexpr std::size_t unknowns = D + spins;    // unknowns of a particle that rotates
  // Numbers that store a rotation: an angle [rad], or a unit quaternion [-].
  static constexpr std::size_t rotation_numbers = D == 2 ? 1 : 4;
  static constexpr std::size_t tangents = D == 2 ? 1 : 3;  // components of a tangential spring
  static constexpr std::size_t lanes = D == 2 ? 4 : 8;     // doubles in a record
};

}  // namespace grainlaw::core
