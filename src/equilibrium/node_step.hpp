// A step of a relaxation: velocity and place of a node from its residual, and what is measured on the way.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_list.hpp"
#include "contact/contact_sides.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core::node_step {

using namespace simd;

// One record per node: translation, and rotation as turned length R theta. Its force M / R makes
// every component a force, and its mass is I / R^2.
struct Nodes {
  double* velocity;
  const double* mass;
  const double* gain;  // 1 / mass, and 0 where nothing moves
  double* z;           // moves along; null: moved by others
};

// v <- keep v + gain r / m, and z <- z + v, node by node; what is measured is of the state before.
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

// On node q at z.
template <int D, std::size_t width = Dimension<D>::lanes>
GRAINLAW_INLINE Lanes<width> drag_on(std::size_t q, const double* z, const NodeDrag<D>& drag) {
  return load<width>(&drag.stiffness[q].x) *
         (load<width>(&drag.expected[q].x) - load<width>(z + width * q));
}

// One for each dimension, by overloads: a template has no clones.
ContactSides<2>::Measured step_all(const Nodes& nodes, std::span<const ForceRecord<2>> residual,
                                   double keep, double gain);
// The same with the sums of the contacts' forces and the drag, which nothing else is asked of.
ContactSides<2>::Measured gather_and_step(const Nodes& nodes, const ContactList<2>& contacts,
                                          const NodeDrag<2>& drag, double keep, double gain);

// Of spheres, whose records have a number that follows from their rotation.
ContactSides<3>::Measured step_all(const Nodes& nodes, std::span<const ForceRecord<3>> residual,
                                   double keep, double gain);
ContactSides<3>::Measured gather_and_step(const Nodes& nodes, const ContactList<3>& contacts,
                                          const NodeDrag<3>& drag, double keep, double gain);

}  // namespace grainlaw::core::node_step
