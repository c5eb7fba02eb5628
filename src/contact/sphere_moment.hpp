// Moments of rolling, twisting, bending and torsion of one contact of spheres; see
// sphere_loops.hpp.
#pragma once

#include "contact/sphere_point.hpp"

#include <span>

namespace grainlaw::core {

// Moment on j, and its derivatives by the branch l, the spins of both spheres, and the start moment
// m_c. It requires a law with moments and a contact that is not open.
template <>
struct ContactMoment<3> {
  Vec<3> moment{};                   // [N m]
  double bending = 0, torsion = 0;   // magnitudes across and along the normal [N m]
  Matrix3 by_branch{};               // [N]
  Matrix3 by_spin_i{}, by_spin_j{};  // [N m]
  Matrix3 by_start{};                // [-]
};
// Share of the moment in the failure of a bond, 1 at failure [-]. @formula bond
inline double bond_share(const ContactMoment<3>& moment, const Bond& bond) {
  const auto share = [](double size, double strength) {
    return strength > 0 ? size / strength : 0;
  };
  return share(moment.bending, bond.bending_strength) +
         share(moment.torsion, bond.torsion_strength);
}
ContactMoment<3> contact_moment(const ContactList<3>& list, std::size_t c,
                                const ContactPoint<3>& point, std::span<const double> coordinates,
                                std::size_t particles, const ContactLaw& law);

}  // namespace grainlaw::core
