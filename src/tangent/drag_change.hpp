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

// Derivatives of the drag, carried from part to part, as changes relative to affine motion.
// @formula viscous
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
  using Components = std::array<simd::Lanes<Dimension<D>::lanes>,
                                static_cast<std::size_t>(Dimension<D>::unknowns)>;
  // Changes of a node's position and velocity at the start of the part, of the length of its spring
  // there, and of its expected position; then of the duration and the logarithm of W.
  struct Changes {
    Components start, velocity, spring, expected;
    simd::Lanes<Dimension<D>::lanes> duration, log_stiffness;
  };
  void find_changes(const Increment<D>& increment, std::size_t q, Changes& changes) const;

  // Per node and component, at the start of the part.
  std::vector<ByDeformation<D>> start_, velocity_, force_;
  bool carried_ = false;  // false: they are zero
};

}  // namespace grainlaw::core
