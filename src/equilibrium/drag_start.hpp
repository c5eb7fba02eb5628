// Start of a part with drag, or of an increment with inertia.
#pragma once

#include "equilibrium/request.hpp"

namespace grainlaw::core {

// Finds the forces at the start of the increment and returns the drag of one of `parts` equal
// parts, or the inertia of the increment. It begins anew afterwards. @formula viscous, inertia-step
template <int D>
DragStart<D> start_drag(const Request<D>& request, int parts, Increment<D>& increment);

}  // namespace grainlaw::core
