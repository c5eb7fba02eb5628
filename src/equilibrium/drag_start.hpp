// How the parts of an increment with drag begin.
#pragma once

#include "equilibrium/request.hpp"
#include "increment/drag.hpp"

namespace grainlaw::core {

// Start of part k of `parts`: share `inertia` of the drag is that of masses, the rest plain drag.
// The first part scales the last displacement by the strain in its direction, the others repeat it.
// @formula inertia
template <int D>
DragStart<D> drag_start(const Request<D>& request, int k, int parts);

}  // namespace grainlaw::core
