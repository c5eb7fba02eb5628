// Boundary conditions of a frame, per side: shared nodes, fixed components, average constraints.
#pragma once

#include "boundary/boundary_space.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

// The space of any plane packing: a periodic cell, or a frame by its sides. A corner belongs to two
// sides and follows the stricter rule. Throws Error (BAD_PACKING) for a frame condition without a
// frame, and for fewer than four particles under a uniform stress. Opposite sides that share
// fluctuations must be copies and have one rule; else it throws too.
BoundarySpace<2> make_boundary_space(const Packing& packing, const BoundaryOptions& options);

// Sets the weight of each pair: 1 / (number of copies) on the frame, or 1 when the option says so.
void weigh_copies(const BoundarySpace<2>& space, const Packing& packing,
                  std::span<const NeighbourPair<2>> pairs, std::vector<double>& weights);

}  // namespace grainlaw::core
