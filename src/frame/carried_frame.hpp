// A frame whose packing becomes a new reference in its deformed state.
#pragma once

#include "boundary/boundary_space.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Makes the present positions the frame's reference where its conditions would otherwise change.
// Call it before the packing is deformed by F.
void keep_reference(const BoundarySpace<2>& space, const Tensor<2>& F, Packing& packing);

// Carries the frame to the packing deformed by F. Call it afterwards.
void carry_frame(const BoundarySpace<2>& space, const Tensor<2>& F, Packing& packing);

}  // namespace grainlaw::core
