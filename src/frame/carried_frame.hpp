// A frame that starts anew from where F has carried it.
#pragma once

#include "boundary/boundary_space.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Where the conditions on the frame would be others if they counted from here, they keep counting from
// where they did: the positions that the packing has now become its reference. Before it is moved.
void keep_reference(const BoundarySpace<2>& space, const Tensor<2>& F, Packing& packing);

// And after it was moved by F.
void carry_frame(const BoundarySpace<2>& space, const Tensor<2>& F, Packing& packing);

}  // namespace grainlaw::core
