// Measures with a formula of their own in the plane.
#pragma once

#include "increment/configuration.hpp"
#include "increment/problem.hpp"
#include "math/tensor.hpp"

namespace grainlaw::core {

// Largest / smallest eigenvalue of the fabric - 1 (Liu, Bosco & Suiker 2019, eq. 38) [-].
double anisotropy(const Tensor<2>& fabric);

// sqrt(1/2 Fa : Fa) of Fa = 4 dev fabric (Guo & Zhao 2014, eqs. 24-25) [-].
double fabric_intensity(const Tensor<2>& fabric);

// Number of inner particles outside the polygon of the frame's boundary [-].
double escaped_particles(const Problem<2>& problem, const Configuration<2>& at);

}  // namespace grainlaw::core
