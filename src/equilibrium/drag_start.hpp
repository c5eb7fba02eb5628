// How the parts of an increment with drag begin.
#pragma once

#include "equilibrium/request.hpp"
#include "increment/drag.hpp"

namespace grainlaw::core {

// Part k of `parts`: an implicit Euler step of masses `inertia` and a drag 1 - inertia. The first part
// expects as much of the last move as the strain goes on in its direction, the others go on.
template <int D>
DragStart<D> drag_start(const Request<D>& request, int k, int parts);

}  // namespace grainlaw::core
