#include "contact/disc_point.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

ContactMoment<2> contact_moment(const ContactList<2>& list, std::size_t c,
                                const ContactPoint<2>& point, std::span<const double> coordinates,
                                std::size_t particles, const ContactLaw& law) {
  const double* rotation = coordinates.data() + 2 * particles;
  const double overlap = list.rest_of(c) - point.distance;
  const double scale = stiffness_scale(overlap, law);
  const double spin = rotation[static_cast<std::size_t>(list.j[c])] -
                      rotation[static_cast<std::size_t>(list.i[c])] - list.start_spin[0][c];
  const double kr = list.bending_stiffness[c] * scale;
  const double start = list.start_moment[0][c] * start_scale(overlap, law);
  const double trial = start - kr * spin;
  const double bound = list.rolling_length[c] * point.normal_force;
  if (point.status != ContactStatus::bonded && !(std::abs(trial) < bound)) {
    const double kn = list.normal_stiffness[c] * scale;
    return {std::copysign(bound, trial), std::copysign(list.rolling_length[c] * kn, -trial), 0,
            true};
  }
  return {trial, law.hertzian() ? (0.5 * kr * spin - 0.25 * start) / overlap : 0, -kr, false};
}

double stored_energy(const ContactList<2>& list, std::span<const double> coordinates,
                     std::size_t particles, const ContactLaw& law) {
  double energy = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto point = contact_point(list, c, coordinates, particles, law);
    if (point.status == ContactStatus::open) continue;
    const double overlap = list.rest_of(c) - point.distance;
    const double scale = stiffness_scale(overlap, law);
    energy += (law.hertzian() ? 0.4 : 0.5) * point.normal_force * overlap;
    const double ft = point.tangential_force;
    if (ft != 0) energy += 0.5 * ft * ft / (list.tangential_stiffness[c] * scale);
    if (!law.moments()) continue;
    const double m = contact_moment(list, c, point, coordinates, particles, law).moment;
    if (m != 0) energy += 0.5 * m * m / (list.bending_stiffness[c] * scale);
  }
  return energy;
}

}  // namespace grainlaw::core
