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
// do not decide their number, so that results do not depend on these. Steps may be in single
// precision.
template <int D>
struct HalfContactColumns {
  static constexpr std::size_t lanes = D == 2 ? 8 : 16;
  static constexpr std::size_t components = Dimension<D>::unknowns;  // of a displacement
  static constexpr std::size_t tangents = Dimension<D>::tangents;
  template <class Real>
  using Lanes = Real[lanes];
  using Doubles = Lanes<double>;

  template <class Real>
  struct alignas(64) NodesOf {
    Lanes<Real> mass, mass_spin, gain, gain_spin;  // gain = 1 / mass
    Lanes<Real> moved[components], velocity[components];
  };
  struct alignas(64) Bounds {
    Doubles least, least_spin, inverse_radius;  // lower bounds of the masses; 1 / R
  };
  template <class Real>
  struct alignas(64) DragOf {
    Lanes<Real> stiffness, stiffness_spin;
    Lanes<Real> distance[components];  // to the expected position
  };
  struct Rotations {
    Doubles spin;  // R_i theta_i + R_j theta_j there
  };
  struct Nothing {};
  // Columns of ContactList<D>, with the node as j.
  struct alignas(64) Start : std::conditional_t<D == 2, Rotations, Nothing> {
    std::int32_t other[lanes];
    Doubles normal_stiffness, offset[D], inverse_reach, normal[D], force[tangents];
  };
  template <class Real>
  struct alignas(D == 2 ? 32 : 64) HalfContactOf {
    std::int32_t other[lanes];
    Lanes<Real> normal[D], normal_stiffness;
    // At the positions: kn overlap, trial force, s.
    Lanes<Real> normal_force, trial[tangents], stretch;
  };
  static constexpr std::size_t displacement_lanes = Dimension<D>::lanes;
  template <class Real>
  struct alignas(displacement_lanes * sizeof(Real)) Displacement {
    Real component[displacement_lanes];
  };

  // What steps change and read, in units of a length [m] and a stiffness [N/m].
  template <class Real>
  struct Steps {
    double length = 1, stiffness = 1;
    simd::Column<NodesOf<Real>> nodes;
    simd::Column<DragOf<Real>> drags;  // empty: none
    simd::Column<HalfContactOf<Real>> half_contacts;
    // Records of the nodes, and of those that pad the last group.
    simd::Column<Displacement<Real>> displacements, last_displacements;
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
  template <class Real>
  using Steps = typename Columns::template Steps<Real>;
  template <class Real>
  using Displacement = typename Columns::template Displacement<Real>;
  using typename Columns::Bounds;
  using typename Columns::Start;

  // Lists the half contacts, which have no weights. least_masses: kn of translations [N/m], that of
  // spins, and 1 / R. Particles are at rest, or keep the velocities of the last list. Spheres sort
  // the contacts that are near at these positions first. Room for steps in single precision is
  // taken where they may be.
  void arrange(const ContactList<D>& list, const Packing& packing,
               std::span<const LeastMass<D>> least_masses,
               std::span<const ParticleRecord<D>> particles, bool at_rest, bool may_be_single);

  // Sets the precision of the steps from the next relinearise() on.
  void step_in_single_precision(bool single);

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
  void find_near(const ContactList<D>& list, std::span<const ParticleRecord<D>> particles);
  void measure_moves();
  template <class Real>
  void begin(Steps<Real>& steps);
  template <class Real>
  void restart(Steps<Real>& steps);
  void choose_units(const ContactList<D>& list);
  void bound_masses(std::span<const LeastMass<D>> least_masses);
  void list_half_contacts(const ContactList<D>& list, double longest_reach);

  // Calls act() with the steps of the present precision.
  template <class Act>
  decltype(auto) with_steps(Act&& act) {
    if (single_precision_) return act(single_);
    return act(steps_);
  }
  template <class Act>
  decltype(auto) with_steps(Act&& act) const {
    if (single_precision_) return act(single_);
    return act(steps_);
  }

  std::size_t particles_ = 0;
  double curvature_ = 0;  // 1 / mean branch [1/m]
  HalfContactSlots<lanes> slots_;
  simd::Column<Bounds> bounds_;
  simd::Column<Start> starts_;
  simd::Column<ParticleRecord<D>> positions_;  // of the nodes, and of those that pad the last group
  Steps<double> steps_;
  Steps<float> single_;
  bool single_precision_ = false;
  std::vector<Velocity> velocity_;  // by particles, while listing
  // Near contacts of spheres have gaps below a margin; rows up to the last near one take part in
  // steps.
  std::vector<double> overlap_;  // by contacts, while listing
  std::vector<char> near_;
  std::vector<HalfContactRows> near_rows_;
  double mean_stiffness_ = 0;  // [N/m]
  double mean_overlap_ = 0;    // [m]
  double moved_ = 0;           // largest displacement between the last two relinearisations [m]
};

}  // namespace grainlaw::core
