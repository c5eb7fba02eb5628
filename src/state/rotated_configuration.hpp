// Configurations rotated by the rotation of an increment.
#pragma once

#include "increment/configuration.hpp"
#include "packing/geometry.hpp"
#include "state/plane_rotations.hpp"
#include "state/rotation.hpp"
#include "state/space_rotations.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core {

template <int D>
void rotate_configuration(const SplitIncrement<D>& increment, const Tensor<D>& F,
                          std::size_t particles, Configuration<D>& configuration) {
  map_positions<D>(increment.rotation, particles, configuration.coordinates.data());
  add_rotation(increment, particles, configuration.coordinates);
  rotate_springs(increment, configuration);
  configuration.deformation = F;
  if (configuration.velocity.empty()) return;
  const Tensor<D>& r = increment.rotation;
  map_positions<D>(r, particles, configuration.velocity.data());
  if constexpr (D == 3) {
    if (configuration.velocity.size() > D * particles)
      map_positions<D>(r, particles, configuration.velocity.data() + D * particles);
  }
  configuration.strain_rate = product<D>(product<D>(r, configuration.strain_rate), transpose<D>(r));
}

}  // namespace grainlaw::core
