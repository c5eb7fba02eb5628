// Forces and stiffness of frictional contacts of discs (Cundall & Strack 1979), friction by return
// mapping from the start of the increment; kinematics objective and moment-balanced.
#pragma once

#include "contact/contact_list.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace grainlaw {

// Sum the forces of all contacts onto the nodes (overwritten): fn = kn overlap, ft =
// clamp(start_force - kt du, +-friction fn), both zero in tension; du = d (turning of the branch -
// lambda_i dtheta_i - lambda_j dtheta_j).
void evaluate_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                       ContactList& list, std::span<ForceRecord> nodes);

// The same, and the history starts anew from here. Returns the energy dissipated since the old
// start: sliding force times slip, and what springs give up as contacts unload or open [J].
double advance_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                        ContactList& list, std::span<ForceRecord> nodes);

// Over all touching contacts.
struct ContactTotals {
  double force;    // sum of the normal forces [N]
  double weights;  // sum of the weights [-]
  int touching;
};

// Sum over the touching contacts of every node (overwritten): kn in x and y [N/m], kt d^2 /
// (R_i + R_j) in roll [N], their number in `unused`.
ContactTotals sum_stiffnesses(std::span<const ParticleRecord> particles, ContactList& list,
                              std::span<ForceRecord> nodes);

enum class ContactStatus : char { open, sticking, sliding };

// One contact seen from its own frame: normal n, tangent t = (-n_y, n_x), distance, forces, and the
// tangential displacement divided by the distance.
struct ContactPoint {
  double branch_x, branch_y, distance, normal_x, normal_y;
  double normal_force, tangential_force;  // with the contact's weight [N]
  double turn;                            // du / d [rad]
  ContactStatus status;
};

ContactPoint contact_point(const ContactList& list, std::size_t c,
                           std::span<const double> coordinates, std::size_t particles,
                           const ContactLaw& law);

// d(fn, ft, d ft) by (normal displacement, tangential displacement, lambda_i theta_i + lambda_j
// theta_j) of the branch, 3 x 3 row-major; the first two rows are the force vector's components in
// the turning frame of the contact. Exact derivative of the law within its status.
std::array<double, 9> contact_stiffness(const ContactPoint& point, double normal_stiffness,
                                        double tangential_stiffness, double friction);

}  // namespace grainlaw
