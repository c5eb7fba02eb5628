// Strategy from an increment of deformation to its equilibrium: a list of stages. Each costs more
// than the one before and solves increments that it did not.
#pragma once

#include "equilibrium/request.hpp"

namespace grainlaw::core {

// On success workspace.increment is at equilibrium, and its history is not yet advanced.
template <int D>
Outcome solve(const Request<D>& request, Workspace<D>& workspace);

}  // namespace grainlaw::core
