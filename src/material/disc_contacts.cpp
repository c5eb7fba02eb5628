// Given contacts of discs.
#include "material/given_contacts.hpp"

namespace grainlaw::core {

template <>
std::array<double, 1> given_force<2>(const Packing& packing, const InitialContact& contact) {
  const Vec<2> branch = given_branch<2>(packing, contact);
  return {(-branch[1] * contact.tangential_force[0] + branch[0] * contact.tangential_force[1]) /
          length<2>(branch)};
}

template <>
std::array<double, 1> given_moment<2>(const InitialContact& contact) {
  return {contact.moment[0]};
}

}  // namespace grainlaw::core
