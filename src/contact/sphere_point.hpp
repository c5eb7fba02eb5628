// One contact of spheres: forces and stiffness, exactly as in the loops over all contacts.
#pragma once

#include "contact/springs.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace grainlaw::core {

using Matrix3 = Tensor<3>;

inline Vec<3> cross(const Vec<3>& a, const Vec<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Vec<3>& a, const Vec<3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
// Computes a + factor b.
inline Vec<3> sum(const Vec<3>& a, double factor, const Vec<3>& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
// Matrix [a]x of the cross product a x b.
inline Matrix3 cross_matrix(const Vec<3>& a) {
  return {0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0};
}
// Adds factor a b^T to m.
inline void add_outer(Matrix3& m, double factor, const Vec<3>& a, const Vec<3>& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[3 * i + j] += factor * a[i] * b[j];
  }
}
inline void add_identity(Matrix3& m, double factor) {
  for (std::size_t k = 0; k < 3; ++k) m[4 * k] += factor;
}
inline void add(Matrix3& m, double factor, const Matrix3& other) {
  for (std::size_t k = 0; k < 9; ++k) m[k] += factor * other[k];
}

// Quaternion with scalar and vector part.
struct Quaternion {
  double s = 1;
  Vec<3> v{};
};

// Unit quaternion of the Gibbs vector 2 tan(angle / 2) e.
inline Quaternion quaternion_of(const Vec<3>& gibbs) {
  const double half = 0.5 / std::sqrt(1 + 0.25 * square<3>(gibbs));
  return {2 * half, {half * gibbs[0], half * gibbs[1], half * gibbs[2]}};
}
// Product a b: rotation b, then a.
inline Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a.s * b.s - dot(a.v, b.v), sum(sum(cross(a.v, b.v), a.s, b.v), b.s, a.v)};
}
inline Quaternion conjugate(const Quaternion& a) { return {a.s, {-a.v[0], -a.v[1], -a.v[2]}}; }

// Rotates g by q, which need not have unit length: q g conj(q) / |q|^2.
inline Vec<3> rotated(const Quaternion& q, const Vec<3>& g) {
  const Vec<3> u = sum(cross(q.v, g), q.s, g);
  return sum(g, 2 / (q.s * q.s + dot(q.v, q.v)), cross(q.v, u));
}

// Contact of spheres: n, t* and their terms. @formula mean-rotation
template <>
struct ContactPoint<3> {
  Vec<3> branch{};  // [m]
  double distance = 0;
  Vec<3> normal{};
  double normal_force = 0;     // with the contact's weight [N]
  Vec<3> tangential_force{};   // on j [N]
  Vec<3> spring{};             // h = Rbar (ft_c + kt d n_c) [N]
  Vec<3> trial{};              // t* [N]
  double trial_size = 0;       // |t*| [N]
  Vec<3> rotated_normal{};     // Rbar n_c
  Vec<3> rotated_start{};      // Rbar ft_c, as stored in the list
  Quaternion mean;             // of the pair, not normalised: R_i q_i + R_j q_j [m]
  Matrix3 spin_i{}, spin_j{};  // A_k in d wbar = sum A_k R_k d omega_k / (R_i + R_j)
  ContactStatus status = ContactStatus::open;

  [[nodiscard]] Vec<3> force_on_j() const { return sum(tangential_force, normal_force, normal); }
  // Directions of the tangential spring.
  [[nodiscard]] std::array<Vec<3>, 2> tangents() const {
    std::size_t least = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (std::abs(normal[k]) < std::abs(normal[least])) least = k;
    }
    Vec<3> axis{};
    axis[least] = 1;
    Vec<3> first = cross(normal, axis);
    const double size = std::sqrt(dot(first, first));
    for (double& component : first) component /= size;
    return {first, cross(normal, first)};
  }
};

// Matrix A = a 1 - [b]x with (a, b) = q conj(mean / reach) / |mean / reach|^2.
inline Matrix3 spin_matrix(const Quaternion& q, const Quaternion& mean, double reach) {
  const double square = (mean.s * mean.s + dot(mean.v, mean.v)) / (reach * reach);
  const Quaternion share = product(q, conjugate(mean));
  const double factor = 1 / (reach * square);
  Matrix3 result{};
  add_identity(result, factor * share.s);
  add(result, -factor, cross_matrix(share.v));
  return result;
}

inline ContactPoint<3> contact_point(const ContactList<3>& list, std::size_t c,
                                     std::span<const double> coordinates, std::size_t particles,
                                     const ContactLaw& law) {
  const auto p = static_cast<std::size_t>(list.i[c]);
  const auto q = static_cast<std::size_t>(list.j[c]);
  const auto of = [&](std::size_t first, std::size_t particle) {
    const double* x = coordinates.data() + first * particles + particle;
    return Vec<3>{x[0], x[particles], x[2 * particles]};
  };
  ContactPoint<3> point;
  const Vec<3> a = of(0, p);
  const Vec<3> b = of(0, q);
  for (std::size_t k = 0; k < 3; ++k) point.branch[k] = b[k] - a[k] + list.offset[k][c];
  point.distance = std::sqrt(square<3>(point.branch) + std::numeric_limits<double>::min());
  for (std::size_t k = 0; k < 3; ++k) point.normal[k] = point.branch[k] / point.distance;
  const double overlap = list.rest_of(c) - point.distance;
  const bool bonded = list.bonded(c);
  if (overlap <= 0 && !bonded) return point;
  point.status = bonded ? ContactStatus::bonded : ContactStatus::sticking;
  point.normal_force = normal_force(list, c, overlap, law);
  if (!law.tangential()) return point;
  Vec<3> start_force{}, start_normal{};
  for (std::size_t k = 0; k < 3; ++k) {
    start_force[k] = list.start_force[k][c];
    start_normal[k] = list.start_normal[k][c];
  }
  point.rotated_normal = start_normal;
  point.rotated_start = start_force;
  if (law.rotating()) {
    const double reach = list.reach[c];
    const double radius_i = list.lever_i[c] * reach;
    const double radius_j = reach - radius_i;
    const Quaternion rotation_i = quaternion_of(of(3, p));
    const Quaternion rotation_j = quaternion_of(of(3, q));
    point.mean.s = radius_i * rotation_i.s + radius_j * rotation_j.s;
    for (std::size_t k = 0; k < 3; ++k) {
      point.mean.v[k] = radius_i * rotation_i.v[k] + radius_j * rotation_j.v[k];
    }
    point.rotated_normal = rotated(point.mean, start_normal);
    point.rotated_start = rotated(point.mean, start_force);
    point.spin_i = spin_matrix(rotation_i, point.mean, reach);
    point.spin_j = spin_matrix(rotation_j, point.mean, reach);
  }
  const double kt = list.tangential_stiffness[c] * stiffness_scale(overlap, law);
  const double scale = start_scale(overlap, law);
  for (std::size_t k = 0; k < 3; ++k) {
    point.spring[k] =
        scale * point.rotated_start[k] + kt * point.distance * point.rotated_normal[k];
  }
  point.trial = sum(point.spring, -dot(point.normal, point.spring), point.normal);
  point.trial_size = std::sqrt(square<3>(point.trial) + std::numeric_limits<double>::min());
  point.tangential_force = point.trial;
  if (bonded) return point;
  const double bound = law.friction * point.normal_force;
  if (point.trial_size <= bound) return point;
  for (double& component : point.tangential_force) component *= bound / point.trial_size;
  point.status = ContactStatus::sliding;
  return point;
}

// Derivatives of the force f on j and the spin moment tau (M / R of both) by branch l and mean
// rotation wbar. Also the derivative of the tangential force by ft_c + kt d n_c.
struct SphereStiffness {
  Matrix3 force_by_branch{}, force_by_rotation{};
  Matrix3 spin_by_branch{}, spin_by_rotation{};
  Matrix3 spring_by_start{};
};

inline SphereStiffness contact_stiffness(const ContactList<3>& list, std::size_t c,
                                         const ContactPoint<3>& point, const ContactLaw& law) {
  const double d = point.distance;
  const double overlap = list.rest_of(c) - d;
  const double scale = stiffness_scale(overlap, law);
  const double kn = list.normal_stiffness[c] * scale;
  const Vec<3>& n = point.normal;
  SphereStiffness k;
  Matrix3 across{};  // Pn = 1 - n n^T
  add_identity(across, 1);
  add_outer(across, -1, n, n);
  Matrix3& by_branch = k.force_by_branch;
  add_outer(by_branch, -kn, n, n);
  add(by_branch, point.normal_force / d, across);
  if (!law.tangential()) return k;

  // Derivatives of the trial force.
  const double kt = list.tangential_stiffness[c] * scale;
  Vec<3> by_distance{};  // of h
  for (std::size_t m = 0; m < 3; ++m) by_distance[m] = kt * point.rotated_normal[m];
  if (law.hertzian()) {
    // kt and the scaled start force depend on the overlap.
    const double start = start_scale(overlap, law);
    for (std::size_t m = 0; m < 3; ++m) {
      by_distance[m] -= 0.5 * kt / overlap * d * point.rotated_normal[m] +
                        0.25 * start / overlap * point.rotated_start[m];
    }
  }
  Matrix3 trial_by_branch{};
  add(trial_by_branch, -dot(n, point.spring) / d, across);
  add_outer(trial_by_branch, -1 / d, n, point.trial);
  add_outer(trial_by_branch, 1, product<3>(across, by_distance), n);
  Matrix3 trial_by_rotation{};
  if (law.rotating()) {
    add(trial_by_rotation, -1, product<3>(across, cross_matrix(point.spring)));
  }

  // Derivatives after the friction limit.
  Matrix3 left{};
  add_identity(left, 1);
  Matrix3 spring_by_branch = trial_by_branch;
  Matrix3 spring_by_rotation = trial_by_rotation;
  if (point.status == ContactStatus::sliding) {
    Vec<3> e{};
    for (std::size_t m = 0; m < 3; ++m) e[m] = point.trial[m] / point.trial_size;
    const double share = law.friction * point.normal_force / point.trial_size;
    left = {};
    add_identity(left, share);
    add_outer(left, -share, e, e);
    spring_by_branch = product<3>(left, trial_by_branch);
    add_outer(spring_by_branch, -law.friction * kn, e, n);
    spring_by_rotation = product<3>(left, trial_by_rotation);
  }
  add(by_branch, 1, spring_by_branch);
  k.force_by_rotation = spring_by_rotation;
  Matrix3 start_by{};  // Rbar, column by column
  for (std::size_t m = 0; m < 3; ++m) {
    Vec<3> axis{};
    axis[m] = 1;
    const Vec<3> start = law.rotating() ? rotated(point.mean, axis) : axis;
    for (std::size_t r = 0; r < 3; ++r) start_by[3 * r + m] = start[r];
  }
  k.spring_by_start = product<3>(left, product<3>(across, start_by));
  if (!law.rotating()) return k;
  const double inverse_reach = list.inverse_reach[c];
  const Matrix3 lever = cross_matrix(point.branch);
  add(k.spin_by_branch, inverse_reach, cross_matrix(point.tangential_force));
  add(k.spin_by_branch, -inverse_reach, product<3>(lever, spring_by_branch));
  add(k.spin_by_rotation, -inverse_reach, product<3>(lever, spring_by_rotation));
  return k;
}

// Energy of the springs of all contacts [J].
double stored_energy(const ContactList<3>& list, std::span<const double> coordinates,
                     std::size_t particles, const ContactLaw& law);

}  // namespace grainlaw::core
