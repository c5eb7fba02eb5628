// Loading from the equilibrium at F = I to the prescribed components of stress.
#pragma once

#include "equilibrium/strategy.hpp"

namespace grainlaw::core {

// Loads from `at` (at F = I, with its stress) to the prescribed components of `space`; steps shrink
// where no equilibrium is found. `request` supplies everything but the start. Throws Error
// (NOT_CONVERGED) that names the unreached stress and the reason.
template <int D>
void load_to_stress(const BoundarySpace<D>& space, const Request<D>& request,
                    Workspace<D>& workspace, Configuration<D>& at);

}  // namespace grainlaw::core
