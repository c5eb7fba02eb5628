// Forces and stiffness of contacts of discs, friction (Cundall & Strack 1979) and rolling resistance
// by return mapping from the start of the increment; kinematics objective and moment-balanced.
#pragma once

#include "contact/contact_list.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace grainlaw {

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
void evaluate_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                       ContactList& list, std::span<ForceRecord> nodes);

// The forces of all contacts of a plain law, left in list.forces without summing them.
void find_contact_forces(std::span<const ParticleRecord> particles, const ContactLaw& law,
                         ContactList& list);

// The same, and the history starts anew from here. Returns the energy dissipated since the old
// start: sliding force times slip, and what springs give up as contacts unload or open [J].
double advance_contacts(std::span<const ParticleRecord> particles, const ContactLaw& law,
                        ContactList& list, std::span<ForceRecord> nodes);

// Over all touching contacts.
struct ContactTotals {
  double force;    // sum of the normal forces, of bonds by magnitude [N]
  double weights;  // sum of the weights [-]
  int touching;
};

// Sum over the touching contacts of every node (overwritten): kn in x and y [N/m], kt d^2 /
// (R_i + R_j) plus kr / R in roll [N].
ContactTotals sum_stiffnesses(std::span<const ParticleRecord> particles, const ContactLaw& law,
                              ContactList& list, std::span<ForceRecord> nodes);

enum class ContactStatus : char { open, sticking, sliding, bonded };

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
std::array<double, 9> contact_stiffness(const ContactList& list, std::size_t c,
                                        const ContactPoint& point, const ContactLaw& law);
// The same of a contact with linear springs.
std::array<double, 9> contact_stiffness(const ContactPoint& point, double normal_stiffness,
                                        double tangential_stiffness, double friction);

// The moment of rolling or bending on j, and its derivatives by the normal displacement [N] and by
// theta_j - theta_i [N m]. Of laws with moments, where the point is not open.
struct ContactMoment {
  double moment, by_normal, by_spin;
  bool capped;  // rolls
};
ContactMoment contact_moment(const ContactList& list, std::size_t c, const ContactPoint& point,
                             std::span<const double> coordinates, std::size_t particles,
                             const ContactLaw& law);

// Normal force at this overlap, negative across a gap whether it is carried or not [N].
double normal_force(const ContactList& list, std::size_t c, double overlap, const ContactLaw& law);

// From what a list starts with to a force (moment) at this overlap: 1 but for Hertz-Mindlin.
double start_scale(double overlap, const ContactLaw& law);

// What the springs of all contacts hold [J].
double stored_energy(const ContactList& list, std::span<const double> coordinates,
                     std::size_t particles, const ContactLaw& law);

}  // namespace grainlaw
