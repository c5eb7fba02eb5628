// Half contacts of a plain law with friction, node by node, with forces as functions of the nodes'
// displacements. Between two relinearisations a relaxation computes no square roots and stores no
// forces.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_list.hpp"
#include "contact/half_contact_slots.hpp"
#include "contact/law.hpp"
#include "math/dimension.hpp"
#include "packing/packing.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Columns of half contacts and their nodes, one lane for each node of a group. The lanes of registers
// do not decide their number, so that results do not depend on these.
template <int D>
struct HalfContactColumns {
  static constexpr std::size_t lanes = HalfContactSlots::lanes;
  static constexpr std::size_t components = Dimension<D>::unknowns;  // of a displacement
  static constexpr std::size_t tangents = Dimension<D>::tangents;
  using Doubles = double[lanes];

  struct Masses {
    Doubles mass, mass_spin, gain, gain_spin;  // gain = 1 / mass
  };
  struct Motion {
    Doubles moved[components], velocity[components];
  };
  struct Rotations {
    Doubles spin;  // R_i theta_i + R_j theta_j there
  };
  template <int>
  struct Nothing {};

  // Discs have their displacements in records alone.
  struct alignas(64) Nodes : Masses, std::conditional_t<D == 3, Motion, Nothing<0>> {};
  struct alignas(64) Bounds {
    Doubles least, least_spin, inverse_radius;  // lower bounds of the masses; 1 / R
  };
  struct alignas(64) Drag {
    Doubles stiffness, stiffness_spin;
    Doubles distance[components];  // to the expected position
  };
  // Columns of ContactList<D>, with the node as j.
  struct alignas(64) Start : std::conditional_t<D == 2, Rotations, Nothing<1>> {
    Doubles offset[D], inverse_reach, normal[D], force[tangents];
  };
  struct alignas(32) HalfContact {
    std::int32_t other[lanes];
    Doubles normal[D], normal_stiffness;
    Doubles normal_force, trial[tangents], stretch;  // at the positions: kn overlap, trial force, s
  };
};

// What a step of a relaxation measures of the state before it.
struct StepMeasures {
  double largest;     // component of the residual r [N]
  double power;       // sum v r
  double next_power;  // sum v r with the velocity after the step
  double inertia;     // sum v m v
};

// Half contacts; every particle is a node of its own. relinearise() sets the positions; the
// displacements u count from them, and w is the change of R_i theta_i + R_j theta_j.
//   fn = max(kn (overlap - n.u), 0);  s = d / (R_i + R_j).
// Discs: ft = clamp(trial - kt (t.u - s w), +-friction fn); normals rotate by t.u over the mean
// branch. Spheres: ft = t* min(1, friction fn / |t*|), t* = trial - kt (u - n (n.u)) + kt s w x n,
// moment over radius -s n x ft; normals stay. Forces are exact at the positions and nearly of first
// order around them.
template <int D>
class HalfContacts : public HalfContactColumns<D> {
 public:
  using Columns = HalfContactColumns<D>;
  using Columns::components;
  using Columns::lanes;
  using typename Columns::Bounds;
  using typename Columns::Drag;
  using typename Columns::HalfContact;
  using typename Columns::Nodes;
  using typename Columns::Start;

  // Lists the half contacts, which have no weights. least_masses: kn of translations [N/m], that of
  // spins, and 1 / R. Particles are at rest, or keep the velocities of the last list.
  void arrange(const ContactList<D>& list, const Packing& packing,
               std::span<const LeastMass<D>> least_masses, bool at_rest);

  // Computes forces at these positions, and masses of `factor` times the larger of
  // sum_stiffnesses() and least_masses. Displacements restart from 0.
  ContactTotals relinearise(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                            double factor, ContactList<D>& list);

  // Adds drag to the forces and, times `factor`, to the masses; follows relinearise() at the same
  // positions.
  void add_drag(std::span<const ParticleRecord<D>> particles, const NodeDrag<D>& drag,
                double factor);

  // Performs v <- keep v + gain r / m and u <- u + v. @formula relaxation
  StepMeasures step(const ContactLaw& law, double keep, double gain);

  // Adds the displacements to particles at the positions of relinearise().
  void displace(std::span<ParticleRecord<D>> particles) const;

 private:
  using Velocity = std::array<double, Columns::components>;

  [[nodiscard]] Velocity velocity(std::size_t particle) const;
  void set_velocity(std::size_t particle, const Velocity& velocity);
  void bound_masses(std::span<const LeastMass<D>> least_masses);
  void list_half_contacts(const ContactList<D>& list, double longest_reach);

  std::size_t particles_ = 0;
  double curvature_ = 0;  // 1 / mean branch [1/m]
  HalfContactSlots slots_;
  simd::Column<Nodes> nodes_;
  simd::Column<Bounds> bounds_;
  simd::Column<Drag> drags_;  // empty: none
  simd::Column<Start> starts_;
  simd::Column<HalfContact> half_contacts_;
  // Records of the nodes, and of those that pad the last group.
  simd::Column<ParticleRecord<D>> positions_, displacements_, last_displacements_;
  std::vector<Velocity> velocity_;  // by particles, while listing
};

}  // namespace grainlaw::core
