// Given contacts of spheres.
#include "material/given_contacts.hpp"

namespace grainlaw::core {

template <>
std::array<double, 3> given_force<3>(const Packing& packing, const InitialContact& contact) {
  // Removes the part along the branch that digits lost in a file leave. Seen from j the force is
  // reversed.
  const Vec<3> l = given_branch<3>(packing, contact);
  const Vec<3>& f = contact.tangential_force;
  const double along = dot<3>(f.data(), l.data()) / square<3>(l);
  const double sign = is_named_from_j(contact) ? -1 : 1;
  Vec<3> result{};
  for (std::size_t k = 0; k < 3; ++k) result[k] = sign * (f[k] - along * l[k]);
  return result;
}

template <>
std::array<double, 3> given_moment<3>(const InitialContact& contact) {
  return contact.moment;
}

}  // namespace grainlaw::core
