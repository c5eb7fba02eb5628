// Configurations turned by the rotation of an increment.
#pragma once

#include "increment/configuration.hpp"
#include "packing/geometry.hpp"
#include "state/plane_turn.hpp"
#include "state/rotation.hpp"
#include "state/space_turn.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core {

template <int D>
void rotate_configuration(const SplitIncrement<D>& increment, const Tensor<D>& F,
                          std::size_t particles, Configuration<D>& configuration) {
  map_positions<D>(increment.rotation, particles, configuration.coordinates.data());
  add_turn(increment, particles, configuration.coordinates);
  turn_springs(increment, configuration.contacts);
  configuration.deformation = F;
}

}  // namespace grainlaw::core
