// Forces of all contacts of discs, and sums of their stiffness: friction (Cundall & Strack 1979) and rolling resistance
// by return mapping from the start of the increment; kinematics objective and moment-balanced.
#pragma once

#include "contact/contact_list.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core {

// Sum the forces of all contacts onto the nodes (overwritten): fn = kn overlap, ft =
// clamp(start_force - kt du, +-friction fn), both zero in tension; du = d (turning of the branch -
// lambda_i dtheta_i - lambda_j dtheta_j).
//   bonded  fn = kn overlap and ft without limit, in tension too.
//   moments  m = clamp(start_moment - kr (dtheta_j - dtheta_i), +-rolling_length fn) on j, -m on i;
// of a bond without limit.
//   Hertz-Mindlin (Guo & Zhao 2014, after eq. 9)  fn = 2/3 kn overlap with kn = G / (1 - nu) sqrt(2
// r overlap), the integral of kn; kt = 2 G / (2 - nu) sqrt(2 r overlap), and when it changes ft
// follows its square root: ft = start_force (kt / start_kt)^1/2 - kt du, likewise m. That is the one
// rule by which ft^2 / 2 kt is an energy: what is stored changes by ft du alone, in closed cycles
// nothing is gained and nothing lost without sliding. It lies midway between the rules in use, a
// kept force (which gains energy) and a kept elongation while unloading (as LAMMPS'
// mindlin_rescale, which loses some in every cycle and has a kink where each increment starts).
template <int D>
void evaluate_contacts(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                       ContactList<D>& list, std::span<ForceRecord<D>> nodes);

// The forces of all contacts, left in list.forces without summing them.
template <int D>
void find_contact_forces(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                         ContactList<D>& list);

// The same, and the history starts anew from here. Returns the energy dissipated since the old
// start: sliding force times slip, and what springs give up as contacts unload or open [J].
template <int D>
double advance_contacts(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                        ContactList<D>& list, std::span<ForceRecord<D>> nodes);

// Over all touching contacts.
struct ContactTotals {
  double force;    // sum of the normal forces, of bonds by magnitude [N]
  double weights;  // sum of the weights [-]
  int touching;
};

// Sum over the touching contacts of every node (overwritten): kn in x and y [N/m], kt d^2 /
// (R_i + R_j) plus kr / R in roll [N].
template <int D>
ContactTotals sum_stiffnesses(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                              ContactList<D>& list, std::span<StiffnessRecord<D>> nodes);

}  // namespace grainlaw::core
