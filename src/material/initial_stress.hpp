// From the equilibrium at F = I to the one under the prescribed components of stress.
#pragma once

#include "equilibrium/strategy.hpp"

namespace grainlaw::core {

// Load from `at` (at F = I, with its stress) until the prescribed components of `space` are reached,
// in steps that shrink where no equilibrium is found. Of the request everything but the start is
// used. Throws Error (NOT_CONVERGED) that names the stress which no state carries, and why.
template <int D>
void load_to_stress(const BoundarySpace<D>& space, const Request<D>& request,
                    Workspace<D>& workspace, Configuration<D>& at);

}  // namespace grainlaw::core
