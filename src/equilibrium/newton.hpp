// Pseudo-transient continuation [kelley1998] in two modes. Full Newton steps cross the changes of
// contact status; where they diverge, implicit Euler steps follow the overdamped flow m dz/dt = r.
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
  std::vector<double> step, residual, coordinates, shifted, best, flow, total;
};

// Solves (K + s M) dz = r with the exact, non-symmetric K until residual_norm() < tolerance.
// @formula newton Full steps may raise the residual for a while. After a few without gain, or one
// without change, they are undone and the flow takes over until it gains. With relaxation memory, a
// short relaxation balances the forces around contacts that changed status in a step. Rolling
// mechanisms rotate to equilibrium before a step. The shift s of the flow falls while the linear
// model is good and rises otherwise. Newton's method on the flow's own equation corrects steps that
// no relaxation settles. With s > 0 the flow is stable exactly where the equilibrium is, flutter
// included. Returns false after max_factorisations (a few more may complete a step), or if the
// residual is not finite.
template <int D>
bool pseudo_transient_newton(Increment<D>& increment, double tolerance, int max_factorisations,
                             NewtonMemory<D>& memory, RelaxationMemory<D>* relaxation = nullptr);

}  // namespace grainlaw::core
