// Pseudo-transient continuation (Kelley & Keyes 1998), in two gaits: full Newton steps through the
// kinks of contacts that open, close, stick and slide; and implicit Euler steps of the overdamped flow
// m dz/dt = r where those lead away.
#pragma once

#include "equilibrium/relaxation.hpp"
#include "equilibrium/rolling_mechanisms.hpp"
#include "equilibrium/sphere_mechanisms.hpp"
#include "increment/increment.hpp"
#include "tangent/bordered_system.hpp"
#include "tangent/stiffness.hpp"

#include <vector>

namespace grainlaw::core {

template <int D>
struct NewtonMemory {
  Stiffness<D> stiffness;
  BorderedSystem border;
  RollingMechanisms<D> mechanisms;
  std::vector<double> step, residual, coordinates, moved, best, flow, total;
};

// Solve (K + s M) dz = r with the exact, non-symmetric K until residual_norm() < tolerance.
// A step on which contacts switch leaves forces out of balance around them: with memory for a short
// relaxation, that settles what the step did not foresee, and may end it all.
// Full steps may pass through states of larger residual all the same; when a few in a row gain
// nothing, or one ends where it began, they are taken back and the flow leads on until it gains.
// Before a step, rolling mechanisms turn to where they are in balance.
// The flow's s falls while the linear model is good and rises when it is not, and a step that no
// relaxation settles is corrected by Newton on its own equation; with s > 0 it is stable exactly
// where the equilibrium is, flutter included. False after max_factorisations, or a few more to end a
// step, or when the residual is no longer finite.
template <int D>
bool pseudo_transient_newton(Increment<D>& increment, double tolerance, int max_factorisations,
                             NewtonMemory<D>& memory, RelaxationMemory<D>* relaxation = nullptr);

}  // namespace grainlaw::core
