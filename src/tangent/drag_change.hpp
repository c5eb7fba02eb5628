// Share of the drag in stiffness and sensitivities.
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Derivative of the rotation of node q, counted from the start of the part, by its spin; row-major.
template <int D>
std::array<double, Dimension<D>::spins * Dimension<D>::spins> rotation_by_spin(
    const Increment<D>& increment, std::size_t q);

// Derivatives of what the drag expects, carried from part to part, as changes relative to affine
// motion. @formula viscous
template <int D>
class DragDerivatives {
 public:
  void reset() { carried_ = false; }

  // Adds the changes of the drag with F and with earlier parts, for affine motion of the nodes.
  void add_to(const Increment<D>& increment, const DeformationChange<D>& change,
              std::span<ByDeformation<D>> residual);

  // Carries the derivatives at the end of a part with this motion of its nodes.
  void carry(const Increment<D>& increment, std::span<const ByDeformation<D>> motion);

 private:
  std::vector<ByDeformation<D>> start_, move_;  // per node and component, at the start of the part
  bool carried_ = false;                        // false: they are zero
};

}  // namespace grainlaw::core
