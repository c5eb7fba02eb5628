// How much larger pseudo-masses are than the normal stiffness of contacts.
#pragma once

#include "base/constants.hpp"
#include "contact/law.hpp"

#include <algorithm>

namespace grainlaw::core {

// The larger of kn and kt over kn, of contacts and of bonds [-]: it bounds the unit step of a
// relaxation.
inline double largest_over_normal(const ContactLaw& law) {
  return law.tangential() ? std::max({1.0, law.ratio, law.of_bonds().ratio}) : 1;
}

// Ratio of pseudo-mass to the sum of kn of the contacts [-].
inline double mass_factor(const ContactLaw& law) {
  return tuned::mass_factor * largest_over_normal(law);
}

}  // namespace grainlaw::core
