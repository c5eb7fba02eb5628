// Configurations turned by the rotation of an increment.
#pragma once

#include "increment/configuration.hpp"
#include "state/plane_turn.hpp"
#include "state/rotation.hpp"
#include "state/space_turn.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core {

// x -> R x
template <int D>
void rotate_positions(const Tensor<D>& rotation, std::size_t particles, double* x) {
  for (std::size_t p = 0; p < particles; ++p) {
    Vec<D> at{};
    for (std::size_t k = 0; k < D; ++k) at[k] = x[k * particles + p];
    const Vec<D> to = product<D>(rotation, at);
    for (std::size_t k = 0; k < D; ++k) x[k * particles + p] = to[k];
  }
}

template <int D>
void rotate_configuration(const SplitIncrement<D>& increment, const Tensor<D>& F,
                          std::size_t particles, Configuration<D>& configuration) {
  rotate_positions<D>(increment.rotation, particles, configuration.coordinates.data());
  add_turn(increment, particles, configuration.coordinates);
  turn_springs(increment, configuration.contacts);
  configuration.deformation = F;
}

}  // namespace grainlaw::core
