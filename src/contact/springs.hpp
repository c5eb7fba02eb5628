// What the springs of one contact share, whatever the dimension.
#pragma once

#include "contact/contact_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace grainlaw::core {

enum class ContactStatus : char { open, sticking, sliding, bonded };

// By what Hertz-Mindlin stiffnesses are multiplied at this overlap; 1 for other laws.
inline double stiffness_scale(double overlap, const ContactLaw& law) {
  return law.hertzian() ? std::sqrt(std::max(overlap, 0.0)) : 1;
}

// From what a list starts with to a force (moment) at this overlap: 1 but for Hertz-Mindlin.
inline double start_scale(double overlap, const ContactLaw& law) {
  return law.hertzian() ? std::sqrt(stiffness_scale(overlap, law)) : 1;
}

// Normal force at this overlap, negative across a gap whether it is carried or not [N].
template <int D>
double normal_force(const ContactList<D>& list, std::size_t c, double overlap,
                    const ContactLaw& law) {
  if (!law.hertzian()) return list.normal_stiffness[c] * overlap;
  return 2.0 / 3 * list.normal_stiffness[c] * stiffness_scale(overlap, law) * overlap;
}

// Of a tangential force in one dimension or more.
inline double magnitude_of(double force) { return std::abs(force); }
inline double magnitude_of(const std::array<double, 1>& force) { return std::abs(force[0]); }
inline double magnitude_of(const Vec<3>& force) { return std::sqrt(square<3>(force)); }

// One contact seen from its own frame, and the moment it carries.
template <int D>
struct ContactPoint;
template <int D>
struct ContactMoment;

}  // namespace grainlaw::core
