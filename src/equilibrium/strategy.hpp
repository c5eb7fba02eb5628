// From an increment of deformation to its equilibrium: a list of stages, each of which costs more than
// the one before and finds what it did not.
#pragma once

#include "equilibrium/request.hpp"

namespace grainlaw::core {

// On success workspace.increment holds the equilibrium, its history not yet advanced.
template <int D>
Outcome solve(const Request<D>& request, Workspace<D>& workspace);

}  // namespace grainlaw::core
