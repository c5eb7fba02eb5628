// Turns of discs.
#pragma once

#include "increment/configuration.hpp"
#include "state/rotation.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core {

// Of discs a turn is one number, and they add up.
inline void add_turn(const SplitIncrement<2>& increment, std::size_t particles,
                     std::vector<double>& z) {
  for (std::size_t k = 2 * particles; k < z.size(); ++k) z[k] += increment.turn[0];
}
// The springs of discs turn with their branches.
inline void turn_springs(const SplitIncrement<2>& /*increment*/,
                         Configuration<2>& /*configuration*/) {}

inline void take_turn(const SplitIncrement<2>& increment, const Configuration<2>& from,
                      std::size_t particles, std::vector<double>& z) {
  for (std::size_t k = 2 * particles; k < z.size(); ++k) {
    z[k] -= from.coordinates[k] + increment.turn[0];
  }
}

}  // namespace grainlaw::core
