// One contact of discs: forces and stiffness in its own frame, and energy of its springs. Functions
// that every iteration calls for every contact are inline, which keeps their many results in
// registers.
#pragma once

#include "contact/disc_rotation.hpp"
#include "contact/springs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace grainlaw::core {

// Contact of discs in its own frame: normal n, tangent t = (-n_y, n_x), distance, forces, and
// tangential displacement over distance.
template <>
struct ContactPoint<2> {
  Vec<2> branch;  // [m]
  double distance;
  Vec<2> normal;
  double normal_force, tangential_force;  // with the contact's weight [N]
  double slip_angle;                      // du / d [rad]
  ContactStatus status;

  // Directions of the tangential spring.
  [[nodiscard]] std::array<Vec<2>, 1> tangents() const { return {Vec<2>{-normal[1], normal[0]}}; }
  [[nodiscard]] Vec<2> force_on_j() const {
    return {normal_force * normal[0] - tangential_force * normal[1],
            normal_force * normal[1] + tangential_force * normal[0]};
  }
};

// Rotation of the branch since the start of the increment [rad].
inline double rotation_of_branch(const ContactList<2>& list, std::size_t c,
                                 const ContactPoint<2>& point) {
  const double cross =
      list.start_normal[0][c] * point.branch[1] - list.start_normal[1][c] * point.branch[0];
  const double dot =
      list.start_normal[0][c] * point.branch[0] + list.start_normal[1][c] * point.branch[1];
  const double sine = cross / point.distance;
  return dot > 0 && std::abs(sine) < short_series ? arc_sine(sine) : std::atan2(cross, dot);
}

inline ContactPoint<2> contact_point(const ContactList<2>& list, std::size_t c,
                                     std::span<const double> coordinates, std::size_t particles,
                                     const ContactLaw& law) {
  const double* x = coordinates.data();
  const double* y = x + particles;
  const auto p = static_cast<std::size_t>(list.i[c]);
  const auto q = static_cast<std::size_t>(list.j[c]);
  ContactPoint<2> point{};
  point.branch[0] = x[q] - x[p] + list.offset[0][c];
  point.branch[1] = y[q] - y[p] + list.offset[1][c];
  point.distance = std::sqrt(point.branch[0] * point.branch[0] + point.branch[1] * point.branch[1] +
                             std::numeric_limits<double>::min());
  point.normal[0] = point.branch[0] / point.distance;
  point.normal[1] = point.branch[1] / point.distance;
  const double overlap = list.rest_of(c) - point.distance;
  const bool bonded = list.bonded(c);
  if (overlap <= 0 && !bonded) return point;
  point.status = bonded ? ContactStatus::bonded : ContactStatus::sticking;
  point.normal_force = normal_force(list, c, overlap, law);
  if (!law.tangential()) return point;
  point.slip_angle = rotation_of_branch(list, c, point);
  if (law.rotating()) {
    const double* rotation = y + particles;
    point.slip_angle += list.start_roll[c] / list.reach[c] - list.lever_i[c] * rotation[p] -
                        (1 - list.lever_i[c]) * rotation[q];
  }
  const double trial = list.start_force[0][c] * start_scale(overlap, law) -
                       list.tangential_stiffness[c] * stiffness_scale(overlap, law) *
                           point.distance * point.slip_angle;
  point.tangential_force = trial;
  if (bonded) return point;
  const double bound = law.friction * point.normal_force;
  point.tangential_force = std::clamp(trial, -bound, bound);
  if (std::abs(trial) > bound) point.status = ContactStatus::sliding;
  return point;
}

// Derivatives of (fn, ft, d ft) for linear springs, 3 x 3 row-major. Columns: normal displacement,
// tangential displacement, and lambda_i theta_i + lambda_j theta_j. The first two rows are the
// force in the rotating frame of the contact. They are exact within the contact's status.
inline std::array<double, 9> contact_stiffness(const ContactPoint<2>& point, double kn, double kt,
                                               double friction) {
  const double d = point.distance;
  const double fn = point.normal_force;
  const double ft = point.tangential_force;
  double by_normal = -kt * point.slip_angle;
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

// Derivatives of (fn, ft, d ft) for any law.
inline std::array<double, 9> contact_stiffness(const ContactList<2>& list, std::size_t c,
                                               const ContactPoint<2>& point,
                                               const ContactLaw& law) {
  const double overlap = list.rest_of(c) - point.distance;
  const double scale = stiffness_scale(overlap, law);
  const double kt = list.tangential_stiffness[c] * scale;
  auto k = contact_stiffness(point, list.normal_stiffness[c] * scale, kt, law.friction);
  if (law.hertzian() && law.tangential() && point.status == ContactStatus::sticking) {
    // kt and the scaled start force depend on the overlap.
    const double d = point.distance;
    const double start = list.start_force[0][c] * start_scale(overlap, law);
    const double by_normal = (0.5 * kt * d * point.slip_angle - 0.25 * start) / overlap;
    k[3] += by_normal;
    k[6] += d * by_normal;
  }
  return k;
}

// Moment of rolling or bending on j [N m], and its derivatives by normal displacement [N] and
// theta_j - theta_i [N m]. It requires a law with moments and a contact that is not open.
// @formula rolling
template <>
struct ContactMoment<2> {
  double moment, by_normal, by_spin;
  bool capped;  // rolls: the moment is at its bound
};
// Share of the moment in the failure of a bond, 1 at failure [-]. @formula bond
inline double bond_share(const ContactMoment<2>& moment, const Bond& bond) {
  return bond.bending_strength > 0 ? std::abs(moment.moment) / bond.bending_strength : 0;
}
ContactMoment<2> contact_moment(const ContactList<2>& list, std::size_t c,
                                const ContactPoint<2>& point, std::span<const double> coordinates,
                                std::size_t particles, const ContactLaw& law);

// Energy of the springs of all contacts [J].
double stored_energy(const ContactList<2>& list, std::span<const double> coordinates,
                     std::size_t particles, const ContactLaw& law);

}  // namespace grainlaw::core
