// A side of a frame whose discs are one body.
#pragma once

#include "boundary/boundary_space.hpp"
#include "packing/packing.hpp"

#include <cstddef>

namespace grainlaw::core {

// The discs of a row take part in F as if they lay on the line between the corners, shifted so
// that the area within stays the same.
void straighten(const Packing& packing, std::size_t side, BoundarySpace<2>& space);

}  // namespace grainlaw::core
