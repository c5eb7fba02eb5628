// The rules of the sides of a frame, as a boundary space: which particles share a node, what is fixed,
// and what is constrained on average.
#pragma once

#include "boundary/boundary_space.hpp"

namespace grainlaw::core {

// Fills what the rules decide; reads what of F is found. Throws Error (BAD_PACKING) as
// make_boundary_space() does.
void space_of_sides(const Packing& packing, const Sides& sides, BoundarySpace<2>& space);

}  // namespace grainlaw::core
