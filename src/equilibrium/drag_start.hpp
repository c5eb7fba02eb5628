// Start of a part with drag.
#pragma once

#include "equilibrium/request.hpp"

namespace grainlaw::core {

// Finds the forces at the start of the increment and returns the drag of one of `parts` equal parts.
// The increment begins anew afterwards. @formula viscous
template <int D>
DragStart<D> start_drag(const Request<D>& request, int parts, Increment<D>& increment);

}  // namespace grainlaw::core
