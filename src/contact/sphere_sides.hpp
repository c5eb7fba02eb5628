// Half contacts of spheres, with forces as functions of the nodes' displacements; see
// disc_sides.hpp.
#pragma once

#include "contact/disc_sides.hpp"
#include "contact/side_slots.hpp"

namespace grainlaw::core {

// Half contacts. look() sets the positions; u are displacements from them, w the change of eta_i +
// eta_j.
//   fn = max(kn (overlap - n.u), 0);  ft = t* min(1, friction fn / |t*|);
//   t* = trial - kt (u - n (n.u)) + kt s w x n;  moment over radius: -s n x ft.
// s = d / (R_i + R_j); normals stay.
template <>
class ContactSides<3> {
 public:
  // Lists the half contacts; see ContactSides<2>. least_masses: kn [N/m], that of spins, and 1 / R.
  void arrange(const ContactList<3>& list, const Packing& packing,
               std::span<const LeastMass<3>> least_masses, bool at_rest);
  ContactTotals look(std::span<const ParticleRecord<3>> particles, const ContactLaw& law,
                     double factor, ContactList<3>& list);
  void hold(std::span<const ParticleRecord<3>> particles, const NodeDrag<3>& drag, double factor);

  using Measured = ContactSides<2>::Measured;
  Measured step(const ContactLaw& law, double keep, double gain);
  void move(std::span<ParticleRecord<3>> particles) const;

  static constexpr std::size_t lanes = SideSlots::lanes;
  static constexpr std::size_t size = 6;  // components of a displacement
  using Doubles = double[lanes];
  struct alignas(64) Nodes {
    Doubles mass, mass_spin, gain, gain_spin;  // gain = 1 / mass
    Doubles moved[size], velocity[size];
  };
  struct alignas(64) Bounds {
    Doubles least, least_spin, inverse_radius;  // lower bounds of the masses; 1 / R
  };
  struct alignas(64) Drag {
    Doubles stiffness, stiffness_spin;
    Doubles distance[size];  // to the expected position
  };
  // Columns of ContactList<3>, with the node as j.
  struct alignas(64) Start {
    Doubles offset[3], inverse_reach, normal[3], force[3];
  };
  struct alignas(32) Side {
    std::int32_t other[lanes];
    Doubles normal[3], normal_stiffness;
    Doubles normal_force, trial[3], stretch;  // at the positions: kn overlap, trial force, s
  };

 private:
  void list_sides(const ContactList<3>& list, double longest_reach);

  std::size_t particles_ = 0;
  SideSlots slots_;
  simd::Column<Nodes> nodes_;
  simd::Column<Bounds> bounds_;
  simd::Column<Drag> drags_;  // empty: none
  simd::Column<Start> starts_;
  simd::Column<Side> sides_;
  // Records of the nodes, and of those that pad the last group.
  simd::Column<ParticleRecord<3>> place_, moves_, next_moves_;
  std::vector<std::array<double, size>> velocity_;  // by particles, while listing
};

}  // namespace grainlaw::core
