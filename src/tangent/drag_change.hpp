// The drag's share of stiffness and sensitivities.
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Changes of the rotation of node q, counted from the start of the part, by its spin: row-major.
template <int D>
std::array<double, Dimension<D>::spins * Dimension<D>::spins> rotation_by_spin(
    const Increment<D>& increment, std::size_t q);

// Derivatives of what the drag expects, carried from part to part. Like motions of nodes, they are what
// is left of a change without the affine motion.
template <int D>
class DragDerivatives {
 public:
  void reset() { carried_ = false; }

  // Add the changes of the drag with F and with what came before, nodes fixed in their affine place.
  void add_to(const Increment<D>& increment, const DeformationChange<D>& change,
              std::span<ByDeformation<D>> residual);

  // Where a part ends with this motion of its nodes: what the next one will expect.
  void carry(const Increment<D>& increment, std::span<const ByDeformation<D>> motion);

 private:
  std::vector<ByDeformation<D>> start_, move_;  // per node and component, at the start of the part
  bool carried_ = false;                        // else they are zero
};

}  // namespace grainlaw::core
