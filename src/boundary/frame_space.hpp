// Boundary conditions of a frame, side by side: which particles share a node, what is fixed, and
// what is constrained on average.
#pragma once

#include "boundary/boundary_space.hpp"

namespace grainlaw {

// Fills what the rules of the sides decide; reads what of F is found. A
// corner belongs to two sides and follows the stricter rule. Throws Error (BAD_PACKING) when
// opposite sides are to share fluctuations and are not copies, when they differ in their rules, or
// when fewer than four particles are under a uniform stress.
void space_of_sides(const Packing& packing, const Sides& sides, BoundarySpace& space);

}  // namespace grainlaw
