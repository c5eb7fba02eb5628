// The boundary condition of a packing of either dimension.
#pragma once

#include "frame/frame_space.hpp"

namespace grainlaw::core {

template <int D>
BoundarySpace<D> space_of(const Packing& packing, const BoundaryOptions& boundary) {
  if constexpr (D == 2) {
    return make_boundary_space(packing, boundary);
  } else {
    return make_cell_space<D>(packing, boundary);
  }
}

}  // namespace grainlaw::core
