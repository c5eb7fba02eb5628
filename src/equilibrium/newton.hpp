// Newton's method made safe: implicit Euler steps of the overdamped flow m dz/dt = r.
#pragma once

#include "equilibrium/increment.hpp"
#include "equilibrium/stiffness.hpp"

#include <vector>

namespace grainlaw {

struct NewtonMemory {
  Stiffness stiffness;
  std::vector<double> step, residual, coordinates;
};

// Solve (K + s M) dz = r with the exact, non-symmetric K until residual_norm() < tolerance. s falls
// while the linear model is good and rises when it is not; with s = 0 this is Newton's method, with
// s > 0 it is stable exactly where the equilibrium is, flutter included. False after
// max_factorisations or when the residual is no longer finite.
bool flow_newton(Increment& increment, double tolerance, int max_factorisations,
                 NewtonMemory& memory);

}  // namespace grainlaw
