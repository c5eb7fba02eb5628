// Boundary conditions of a frame, side by side: which particles share a node, what is fixed, and
// what is constrained on average.
#pragma once

#include "boundary/boundary_space.hpp"

namespace grainlaw {

// Fills node, fixed, boundary, average, reference, found and rows by the rules of the sides. A
// corner belongs to two sides and follows the stricter rule. Throws Error (BAD_PACKING) when
// opposite sides are to share fluctuations and are not copies, when they differ in their rules, or
// when fewer than four particles are under a uniform stress.
void space_of_sides(const Packing& packing, const Sides& sides, BoundarySpace& space);

}  // namespace grainlaw
