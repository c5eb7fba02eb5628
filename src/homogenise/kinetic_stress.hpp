// Kinetic part of the stress of an increment with inertia, and the kinetic energy. @formula inertia
#pragma once

#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

#include <cstddef>

namespace grainlaw::core {

// Adds -(1 / V) sum m v (x) F^-1 v to P. Without inertia, and for fluctuations bound to axes, whose
// velocities do not follow F, nothing.
template <int D>
void add_kinetic_stress(const Increment<D>& increment, Tensor<D>& stress);

// Adds its changes for the lanes of the sensitivity; column k is of lane k.
template <int D>
void add_kinetic_changes(const Increment<D>& increment, const Sensitivity<D>& sensitivity,
                         std::size_t lanes, Tensor4<D>& tangent);

// Kinetic energy of the fluctuations, 0 without inertia [J].
template <int D>
double kinetic_energy(const Problem<D>& problem, const Configuration<D>& at);

}  // namespace grainlaw::core
