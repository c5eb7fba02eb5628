// Rules of a frame's sides as a boundary space: shared nodes, fixed components, average
// constraints.
#pragma once

#include "boundary/boundary_space.hpp"

namespace grainlaw::core {

// Sets what the rules decide; `space.found` is an input. Throws Error (BAD_PACKING) as
// make_boundary_space() does.
void space_of_sides(const Packing& packing, const Sides& sides, BoundarySpace<2>& space);

}  // namespace grainlaw::core
