// What the number of dimensions decides.
#pragma once

#include <cstddef>

namespace grainlaw::core {

template <int D>
struct Dimension {
  static_assert(D == 2 || D == 3);
  static constexpr std::size_t spins = D == 2 ? 1 : 3;  // components of a rotation
  static constexpr std::size_t unknowns = D + spins;    // of a particle that rotates
  // A rotation is kept in: an angle [rad], or a unit quaternion [-].
  static constexpr std::size_t turn_numbers = D == 2 ? 1 : 4;
  static constexpr std::size_t tangents = D == 2 ? 1 : 3;  // components of a tangential spring
  static constexpr std::size_t lanes = D == 2 ? 4 : 8;     // doubles of a record
};

}  // namespace grainlaw::core
