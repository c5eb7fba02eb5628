// The moment of rolling, twisting, bending and torsion of one contact of spheres, as sphere_loops.hpp has it.
#pragma once

#include "contact/sphere_point.hpp"

#include <span>

namespace grainlaw::core {

// On j, and what it changes by with the branch l, the spins of both and Rbar m_c's m_c. Of laws with
// moments, where the point is not open.
template <>
struct ContactMoment<3> {
  Vec<3> moment{};                   // [N m]
  double bending = 0, torsion = 0;   // its sizes across and along the normal [N m]
  Matrix3 by_branch{};               // [N]
  Matrix3 by_spin_i{}, by_spin_j{};  // [N m]
  Matrix3 by_start{};                // [-]
};
// Its part of what breaks a bond, 1 at failure [-].
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
