// Boundary conditions of a frame, side by side: which particles share a node, what is fixed, and
// what is constrained on average.
#pragma once

#include "boundary/boundary_space.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

// Of any packing: a periodic cell, or a frame by its sides. A corner belongs to two sides and follows
// the stricter rule. Throws Error (BAD_PACKING) when a frame condition lacks its frame, when opposite
// sides are to share fluctuations and are not copies, when they differ in their rules, or when fewer
// than four particles are under a uniform stress.
BoundarySpace<2> make_boundary_space(const Packing& packing, const BoundaryOptions& options);

// 1 / (number of copies) of each pair on the frame, or 1 when the option says so.
void weigh_copies(const BoundarySpace<2>& space, const Packing& packing,
                  std::span<const NeighbourPair<2>> pairs, std::vector<double>& weights);

}  // namespace grainlaw::core
