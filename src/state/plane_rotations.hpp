// Rotations of discs.
#pragma once

#include "increment/configuration.hpp"
#include "state/rotation.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core {

// Adds the rotation R of the increment to the angles, which add up in the plane.
inline void add_rotation(const SplitIncrement<2>& increment, std::size_t particles,
                         std::vector<double>& z) {
  for (std::size_t k = 2 * particles; k < z.size(); ++k) z[k] += increment.rotation_vector[0];
}
// Springs of discs rotate with their branches; nothing to do.
inline void rotate_springs(const SplitIncrement<2>& /*increment*/,
                           Configuration<2>& /*configuration*/) {}

inline void to_relative_rotation(const SplitIncrement<2>& increment, const Configuration<2>& from,
                                 std::size_t particles, std::vector<double>& z) {
  for (std::size_t k = 2 * particles; k < z.size(); ++k) {
    z[k] -= from.coordinates[k] + increment.rotation_vector[0];
  }
}

}  // namespace grainlaw::core
