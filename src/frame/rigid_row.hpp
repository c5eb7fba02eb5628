// A side of a frame whose discs form one rigid body.
#pragma once

#include "boundary/boundary_space.hpp"
#include "packing/packing.hpp"

#include <cstddef>

namespace grainlaw::core {

// Moves the reference of the row's discs onto the line between the corners, shifted so that the
// enclosed area is unchanged.
void straighten(const Packing& packing, std::size_t side, BoundarySpace<2>& space);

}  // namespace grainlaw::core
