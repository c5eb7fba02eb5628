// The contacts of a plain law with friction, each from both its sides, node by node; and their forces as functions
// of how far the nodes moved from one place. Between two looks at the geometry a relaxation needs no
// square roots, and no force goes through memory.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_list.hpp"
#include "contact/law.hpp"
#include "contact/side_slots.hpp"
#include "packing/packing.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Every particle is a node of its own. At a place, set by look(), with the moves u from it:
//   fn = max(kn (overlap - n.u), 0), ft = clamp(trial - kt (t.u - s w), +-friction fn)
// with s = d / (R_i + R_j), w the change of R_i theta_i + R_j theta_j, and normals that turn by t.u over
// the mean branch: the law's forces at the place, and nearly so to first order around it.
template <int D>
class ContactSides;

template <>
class ContactSides<2> {
 public:
  // Lists the sides of the contacts, which have no weights. least_masses: kn in x [N/m], kt in roll,
  // and 1 / R. Particles are at rest, or keep the velocities they had in the last list.
  void arrange(const ContactList<2>& list, const Packing& packing,
               std::span<const LeastMass<2>> least_masses, bool at_rest);

  // Forces at this place, and masses: `factor` times the larger of sum_stiffnesses() and least_masses.
  // From here on nothing has moved.
  ContactTotals look(std::span<const ParticleRecord<2>> particles, const ContactLaw& law,
                     double factor, ContactList<2>& list);

  // After a look, from the same place: the drag is part of the forces and, times `factor`, of the masses.
  void hold(std::span<const ParticleRecord<2>> particles, const NodeDrag<2>& drag, double factor);

  struct Measured {
    double largest;     // component of the residual r [N]
    double power;       // sum v r
    double next_power;  // the same of the velocity after the step
    double inertia;     // sum v m v
  };
  // v <- keep v + gain r / m, and u <- u + v; what is measured is of the state before.
  Measured step(const ContactLaw& law, double keep, double gain);

  // Particles that are at the place follow the moves.
  void move(std::span<ParticleRecord<2>> particles) const;

  // Nodes of a group: results do not depend on how many lanes registers have.
  static constexpr std::size_t lanes = SideSlots::lanes;
  using Doubles = double[lanes];
  struct alignas(64) Nodes {
    Doubles mass, mass_roll, gain, gain_roll;  // gain = 1 / mass
  };
  struct alignas(64) Bounds {
    Doubles least, least_roll, inverse_radius;  // masses are no smaller; 1 / R
  };
  struct alignas(64) Drag {
    Doubles stiffness, stiffness_roll, x, y, roll;  // as far off is what is expected
  };
  // As in ContactList<2>, with the node as j.
  struct alignas(64) Start {
    Doubles offset_x, offset_y, inverse_reach, x, y, roll, force;
  };
  struct alignas(32) Side {
    std::int32_t other[lanes];
    Doubles normal_x, normal_y, normal_stiffness;
    Doubles normal_force, trial, stretch;  // at the place: kn overlap, the trial force, s
  };

 private:
  void save_velocities();
  void restore_velocities();
  void bound_masses(std::span<const LeastMass<2>> least_masses);
  void list_sides(const ContactList<2>& list, double longest_reach);

  std::size_t particles_ = 0;
  double curvature_ = 0;  // 1 / mean branch [1/m]
  SideSlots slots_;
  simd::Column<Nodes> nodes_;
  simd::Column<Bounds> bounds_;
  simd::Column<Drag> drags_;  // empty: none
  simd::Column<Start> starts_;
  simd::Column<Side> sides_;
  // Of the nodes, and of those that fill up the last group. The velocity is what the moves grew by in
  // the last step.
  simd::Column<ParticleRecord<2>> place_, moves_, last_moves_;
  std::vector<ParticleRecord<2>> velocity_;  // by particles, while listing
};

}  // namespace grainlaw::core
