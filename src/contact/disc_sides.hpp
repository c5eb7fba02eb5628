// Half contacts of a plain law with friction, node by node, with forces as functions of the nodes'
// displacements. Between two relinearisations a relaxation computes no square roots and stores no
// forces.
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

// Half contacts; every particle is a node of its own. look() sets the positions; the displacements
// u count from them.
//   fn = max(kn (overlap - n.u), 0);  ft = clamp(trial - kt (t.u - s w), +-friction fn).
// s = d / (R_i + R_j), and w is the change of R_i theta_i + R_j theta_j. Normals rotate by t.u over
// the mean branch. Forces are exact at the positions and nearly of first order around them.
template <int D>
class ContactSides;

template <>
class ContactSides<2> {
 public:
  // Lists the half contacts, which have no weights. least_masses: kn in x [N/m], kt in roll, and 1
  // / R. Particles are at rest, or keep the velocities of the last list.
  void arrange(const ContactList<2>& list, const Packing& packing,
               std::span<const LeastMass<2>> least_masses, bool at_rest);

  // Relinearises: forces at these positions, and masses of `factor` times the larger of
  // sum_stiffnesses() and least_masses. Displacements restart from 0.
  ContactTotals look(std::span<const ParticleRecord<2>> particles, const ContactLaw& law,
                     double factor, ContactList<2>& list);

  // Adds drag to the forces and, times `factor`, to the masses; follows look() at the same
  // positions.
  void hold(std::span<const ParticleRecord<2>> particles, const NodeDrag<2>& drag, double factor);

  struct Measured {
    double largest;     // component of the residual r [N]
    double power;       // sum v r
    double next_power;  // sum v r with the velocity after the step
    double inertia;     // sum v m v
  };
  // Performs v <- keep v + gain r / m and u <- u + v. Measured values belong to the state before.
  // @formula relaxation
  Measured step(const ContactLaw& law, double keep, double gain);

  // Adds the displacements to particles at the positions of look().
  void move(std::span<ParticleRecord<2>> particles) const;

  // Nodes per group, whatever the lanes of registers, so that results do not depend on these.
  static constexpr std::size_t lanes = SideSlots::lanes;
  using Doubles = double[lanes];
  struct alignas(64) Nodes {
    Doubles mass, mass_roll, gain, gain_roll;  // gain = 1 / mass
  };
  struct alignas(64) Bounds {
    Doubles least, least_roll, inverse_radius;  // lower bounds of the masses; 1 / R
  };
  struct alignas(64) Drag {
    Doubles stiffness, stiffness_roll, x, y, roll;  // distances to the expected position
  };
  // Columns of ContactList<2>, with the node as j.
  struct alignas(64) Start {
    Doubles offset_x, offset_y, inverse_reach, x, y, roll, force;
  };
  struct alignas(32) Side {
    std::int32_t other[lanes];
    Doubles normal_x, normal_y, normal_stiffness;
    Doubles normal_force, trial, stretch;  // at the positions: kn overlap, trial force, s
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
  // Records of the nodes, and of those that pad the last group. The velocity is the displacement of
  // the last step.
  simd::Column<ParticleRecord<2>> place_, moves_, last_moves_;
  std::vector<ParticleRecord<2>> velocity_;  // by particles, while listing
};

}  // namespace grainlaw::core
