// Forces of all contacts and sums of their stiffnesses. Friction and rolling resistance by return
// mapping from the start of the increment [cundall1979]; objective and in balance of moments.
// @formula friction
#pragma once

#include "contact/contact_list.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core {

// Sums the forces of all contacts onto the nodes, which are overwritten. @formula friction
// @formula tangential
//   linear   fn = kn overlap; ft = clamp(start_force - kt du, +-friction fn); both 0 in tension.
//   bonded   fn = kn overlap and ft without limit, in tension too.
//   moments  m = clamp(start_moment - kr (dtheta_j - dtheta_i), +-rolling_length fn) on j, -m on i;
//            for bonds without limit. @formula rolling
//   Hertz-Mindlin  fn = 2/3 kn overlap, the integral of kn. When kt changes, force and moment scale
//            by its root: ft = start_force (kt / start_kt)^1/2 - kt du. @formula hertz
// With that scaling alone ft^2 / 2 kt is an energy: closed cycles without sliding neither gain nor
// lose. Other codes keep the force, which gains energy, or keep the elongation while unloading
// (mindlin_rescale of LAMMPS). The latter loses energy in every cycle and has a kink at the start
// of each increment.
template <int D>
void evaluate_contacts(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                       ContactList<D>& list, std::span<ForceRecord<D>> nodes);

// Computes the forces of all contacts into list.forces, without summing them.
template <int D>
void find_contact_forces(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                         ContactList<D>& list);

// Computes and sums the forces, and restarts the history here. Returns the energy dissipated since
// the old start [J]: sliding force times slip, and spring energy lost in unloading or opening
// contacts.
template <int D>
double advance_contacts(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                        ContactList<D>& list, std::span<ForceRecord<D>> nodes);

// Totals over all touching contacts.
struct ContactTotals {
  double force;    // sum of the normal forces, for bonds of their magnitudes [N]
  double weights;  // sum of the weights [-]
  int touching;
};

// Sums stiffnesses of the touching contacts onto the nodes, which are overwritten: kn in x and y
// [N/m], kt d^2 / (R_i + R_j) + kr / R in roll [N].
template <int D>
ContactTotals sum_stiffnesses(std::span<const ParticleRecord<D>> particles, const ContactLaw& law,
                              ContactList<D>& list, std::span<StiffnessRecord<D>> nodes);

}  // namespace grainlaw::core
