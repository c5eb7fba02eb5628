#include "contact/frictional.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

namespace {

constexpr double tiny = std::numeric_limits<double>::min();

// By what Hertz-Mindlin stiffnesses are multiplied at this overlap.
double stiffness_scale(double overlap, const ContactLaw& law) {
  return law.hertzian() ? std::sqrt(std::max(overlap, 0.0)) : 1;
}

}  // namespace

double start_scale(double overlap, const ContactLaw& law) {
  return law.hertzian() ? std::sqrt(stiffness_scale(overlap, law)) : 1;
}

double normal_force(const ContactList& list, std::size_t c, double overlap, const ContactLaw& law) {
  if (!law.hertzian()) return list.normal_stiffness[c] * overlap;
  return 2.0 / 3 * list.normal_stiffness[c] * stiffness_scale(overlap, law) * overlap;
}

ContactPoint contact_point(const ContactList& list, std::size_t c,
                           std::span<const double> coordinates, std::size_t particles,
                           const ContactLaw& law) {
  const double* x = coordinates.data();
  const double* y = x + particles;
  const auto p = static_cast<std::size_t>(list.i[c]);
  const auto q = static_cast<std::size_t>(list.j[c]);
  ContactPoint point{};
  point.branch_x = x[q] - x[p] + list.offset_x[c];
  point.branch_y = y[q] - y[p] + list.offset_y[c];
  point.distance =
      std::sqrt(point.branch_x * point.branch_x + point.branch_y * point.branch_y + tiny);
  point.normal_x = point.branch_x / point.distance;
  point.normal_y = point.branch_y / point.distance;
  const double overlap = list.rest_of(c) - point.distance;
  const bool bonded = list.bonded(c);
  if (overlap <= 0 && !bonded) return point;
  point.status = bonded ? ContactStatus::bonded : ContactStatus::sticking;
  point.normal_force = normal_force(list, c, overlap, law);
  if (!law.tangential()) return point;
  point.turn = std::atan2(list.start_x[c] * point.branch_y - list.start_y[c] * point.branch_x,
                          list.start_x[c] * point.branch_x + list.start_y[c] * point.branch_y);
  if (law.rotating()) {
    const double* rotation = y + particles;
    point.turn += list.start_roll[c] / list.reach[c] - list.lever_i[c] * rotation[p] -
                  (1 - list.lever_i[c]) * rotation[q];
  }
  const double trial =
      list.start_force[c] * start_scale(overlap, law) -
      list.tangential_stiffness[c] * stiffness_scale(overlap, law) * point.distance * point.turn;
  point.tangential_force = trial;
  if (bonded) return point;
  const double bound = law.friction * point.normal_force;
  point.tangential_force = std::clamp(trial, -bound, bound);
  if (std::abs(trial) > bound) point.status = ContactStatus::sliding;
  return point;
}

std::array<double, 9> contact_stiffness(const ContactPoint& point, double kn, double kt,
                                        double friction) {
  const double d = point.distance;
  const double fn = point.normal_force;
  const double ft = point.tangential_force;
  double by_normal = -kt * point.turn;
  double by_tangential = -kt;
  double by_rotation = kt * d;
  if (point.status == ContactStatus::sliding) {
    by_normal = std::copysign(friction * kn, -ft);
    by_tangential = 0;
    by_rotation = 0;
  }
  return {-kn,
          -ft / d,
          0,
          by_normal,
          by_tangential + fn / d,
          by_rotation,
          ft + d * by_normal,
          d * by_tangential,
          d * by_rotation};
}

std::array<double, 9> contact_stiffness(const ContactList& list, std::size_t c,
                                        const ContactPoint& point, const ContactLaw& law) {
  const double overlap = list.rest_of(c) - point.distance;
  const double scale = stiffness_scale(overlap, law);
  const double kt = list.tangential_stiffness[c] * scale;
  auto k = contact_stiffness(point, list.normal_stiffness[c] * scale, kt, law.friction);
  if (law.hertzian() && law.tangential() && point.status == ContactStatus::sticking) {
    // kt and the share of the start follow the overlap.
    const double d = point.distance;
    const double start = list.start_force[c] * start_scale(overlap, law);
    const double by_normal = (0.5 * kt * d * point.turn - 0.25 * start) / overlap;
    k[3] += by_normal;
    k[6] += d * by_normal;
  }
  return k;
}

ContactMoment contact_moment(const ContactList& list, std::size_t c, const ContactPoint& point,
                             std::span<const double> coordinates, std::size_t particles,
                             const ContactLaw& law) {
  const double* rotation = coordinates.data() + 2 * particles;
  const double overlap = list.rest_of(c) - point.distance;
  const double scale = stiffness_scale(overlap, law);
  const double spin = rotation[static_cast<std::size_t>(list.j[c])] -
                      rotation[static_cast<std::size_t>(list.i[c])] - list.start_spin[c];
  const double kr = list.bending_stiffness[c] * scale;
  const double start = list.start_moment[c] * start_scale(overlap, law);
  const double trial = start - kr * spin;
  const double bound = list.rolling_length[c] * point.normal_force;
  if (point.status != ContactStatus::bonded && !(std::abs(trial) < bound)) {
    const double kn = list.normal_stiffness[c] * scale;
    return {std::copysign(bound, trial), std::copysign(list.rolling_length[c] * kn, -trial), 0,
            true};
  }
  return {trial, law.hertzian() ? (0.5 * kr * spin - 0.25 * start) / overlap : 0, -kr, false};
}

double stored_energy(const ContactList& list, std::span<const double> coordinates,
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

}  // namespace grainlaw
