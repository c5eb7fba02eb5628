// Step of a relaxation: velocity and position of a node from its residual, and the sums measured on
// the way.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_list.hpp"
#include "contact/half_contacts.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core::node_step {

using namespace simd;

// Records of the nodes: translation [m], and rotation as the length R theta [m]. Moments enter as M
// / R [N], moments of inertia as I / R^2.
struct Nodes {
  double* velocity;
  const double* mass;
  const double* gain;  // 1 / mass; 0 for fixed components
  double* z;           // positions to update; null: the caller updates them
};

// Performs v <- keep v + gain r / m and z <- z + v, node by node. Measured sums belong to the state
// before the step. @formula relaxation
template <std::size_t width>
class NodeStep {
  using Record = Lanes<width>;

 public:
  GRAINLAW_INLINE NodeStep(const Nodes& nodes, double keep, double gain)
      : nodes_(nodes), keep_(keep), gain_(gain) {}

  GRAINLAW_INLINE void operator()(std::size_t q, const Record& r) {
    const std::size_t k = width * q;
    const Record v = load<width>(nodes_.velocity + k);
    largest_ = largest(largest_, magnitude(r));
    power_ += v * r;
    inertia_ += v * load<width>(nodes_.mass + k) * v;
    const Record next = keep_ * v + gain_ * r * load<width>(nodes_.gain + k);
    next_power_ += next * r;
    store(nodes_.velocity + k, next);
    if (nodes_.z != nullptr) store(nodes_.z + k, load<width>(nodes_.z + k) + next);
  }

  template <class Measured>
  GRAINLAW_INLINE Measured measured() const {
    return {most(largest_), sum(power_), sum(next_power_), sum(inertia_)};
  }

 private:
  Nodes nodes_;
  double keep_, gain_;
  Record largest_{}, power_{}, next_power_{}, inertia_{};
};

// Drag on node q at position z [N].
template <int D, std::size_t width = Dimension<D>::lanes>
GRAINLAW_INLINE Lanes<width> drag_on(std::size_t q, const double* z, const NodeDrag<D>& drag) {
  return load<width>(&drag.stiffness[q].x) *
         (load<width>(&drag.expected[q].x) - load<width>(z + width * q));
}

// Overloads for each dimension, because templates have no clones per instruction set.
StepMeasures step_all(const Nodes& nodes, std::span<const ForceRecord<2>> residual, double keep,
                      double gain);
// Steps each node with the sum of its contact forces and its drag, without storing that sum.
StepMeasures gather_and_step(const Nodes& nodes, const ContactList<2>& contacts,
                             const NodeDrag<2>& drag, double keep, double gain);

// Overloads for spheres also renew the record's factor `half`, which follows from the rotation.
StepMeasures step_all(const Nodes& nodes, std::span<const ForceRecord<3>> residual, double keep,
                      double gain);
StepMeasures gather_and_step(const Nodes& nodes, const ContactList<3>& contacts,
                             const NodeDrag<3>& drag, double keep, double gain);

}  // namespace grainlaw::core::node_step
