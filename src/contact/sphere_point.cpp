#include "contact/sphere_moment.hpp"

namespace grainlaw::core {

double stored_energy(const ContactList<3>& list, std::span<const double> coordinates,
                     std::size_t particles, const ContactLaw& law) {
  double energy = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto point = contact_point(list, c, coordinates, particles, law);
    if (point.status == ContactStatus::open) continue;
    const double overlap = list.rest_of(c) - point.distance;
    const double scale = stiffness_scale(overlap, law);
    energy += (law.hertzian() ? 0.4 : 0.5) * point.normal_force * overlap;
    const double squares = square<3>(point.tangential_force);
    if (squares != 0) energy += 0.5 * squares / (list.tangential_stiffness[c] * scale);
    if (!law.moments()) continue;
    const auto moment = contact_moment(list, c, point, coordinates, particles, law);
    const auto add = [&](double size, double stiffness) {
      if (stiffness > 0) energy += 0.5 * size * size / (stiffness * scale);
    };
    add(moment.bending, list.bending_stiffness[c]);
    add(moment.torsion, list.torsion_stiffness[c]);
  }
  return energy;
}

}  // namespace grainlaw::core
