#include "frame/carried_frame.hpp"

#include "frame/frame.hpp"

namespace grainlaw::core {

namespace {

// Whether conditions keep their meaning when this state becomes the reference. Fluctuations with
// zero average, or bound to axes, are relative to the first reference.
bool is_its_own_reference(const BoundarySpace<2>& space, const Tensor<2>& F) {
  return F == identity<2>() && !space.averages() && !space.bound_to_axes();
}

}  // namespace

void keep_reference(const BoundarySpace<2>& space, const Tensor<2>& F, Packing& packing) {
  if (!packing.frame || is_its_own_reference(space, F)) return;
  if (packing.frame->reference.empty()) packing.frame->reference = packing.position;
}

void carry_frame(const BoundarySpace<2>& space, const Tensor<2>& F, Packing& packing) {
  if (!packing.frame || is_its_own_reference(space, F)) return;
  packing.frame->deformation = product<2>(F, packing.frame->deformation);
  complete_frame(packing);
}

}  // namespace grainlaw::core
