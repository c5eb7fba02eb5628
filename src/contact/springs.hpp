// Functions of a contact's springs in any dimension.
#pragma once

#include "contact/contact_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace grainlaw::core {

enum class ContactStatus : char { open, sticking, sliding, bonded };

// Factor of Hertz-Mindlin stiffnesses at this overlap; 1 for other laws.
inline double stiffness_scale(double overlap, const ContactLaw& law) {
  return law.hertzian() ? std::sqrt(std::max(overlap, 0.0)) : 1;
}

// Factor from the list's start force (moment) to the force at this overlap; 1 except for
// Hertz-Mindlin.
inline double start_scale(double overlap, const ContactLaw& law) {
  return law.hertzian() ? std::sqrt(stiffness_scale(overlap, law)) : 1;
}

// Normal force at this overlap [N]; negative across a gap, whether or not it is transmitted.
template <int D>
double normal_force(const ContactList<D>& list, std::size_t c, double overlap,
                    const ContactLaw& law) {
  if (!law.hertzian()) return list.normal_stiffness[c] * overlap;
  return 2.0 / 3 * list.normal_stiffness[c] * stiffness_scale(overlap, law) * overlap;
}

// Magnitude of a tangential force in one dimension or more.
inline double magnitude_of(double force) { return std::abs(force); }
inline double magnitude_of(const std::array<double, 1>& force) { return std::abs(force[0]); }
inline double magnitude_of(const Vec<3>& force) { return std::sqrt(square<3>(force)); }

// One contact in its own frame, and its moment.
template <int D>
struct ContactPoint;
template <int D>
struct ContactMoment;

}  // namespace grainlaw::core
