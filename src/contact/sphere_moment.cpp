#include "contact/sphere_moment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

// Adds factor a b to m.
void add_product(Matrix3& m, double factor, const Matrix3& a, const Matrix3& b) {
  add(m, factor, product<3>(a, b));
}

// Trial moment m* limited by the bounds, in its parts along and across n.
struct Cap {
  Vec<3> normal;
  Matrix3 roll_left{}, twist_left{};  // by dm*
  Vec<3> roll_by_bound{}, twist_by_bound{};
  double roll_share = 1, twist_share = 1;
};

Cap cap_of(ContactMoment<3>& result, const Vec<3>& n, const Vec<3>& trial, double roll_bound,
           double twist_bound, bool bonded) {
  const double twist = dot(n, trial);
  const Vec<3> roll = sum(trial, -twist, n);
  const double size = std::sqrt(square<3>(roll) + std::numeric_limits<double>::min());
  Cap cap;
  cap.normal = n;
  add_identity(cap.roll_left, 1);
  add_outer(cap.roll_left, -1, n, n);
  add_outer(cap.twist_left, 1, n, n);
  result.bending = size;
  result.torsion = std::abs(twist);
  if (!bonded && !(size < roll_bound)) {
    cap.roll_share = roll_bound / size;
    for (std::size_t k = 0; k < 3; ++k) cap.roll_by_bound[k] = roll[k] / size;
    for (double& component : cap.roll_left) component *= cap.roll_share;
    add_outer(cap.roll_left, -cap.roll_share, cap.roll_by_bound, cap.roll_by_bound);
    result.bending = roll_bound;
  }
  double carried = twist;
  if (!bonded && !(std::abs(twist) < twist_bound)) {
    carried = std::copysign(twist_bound, twist);
    cap.twist_share = twist != 0 ? carried / twist : 0;
    cap.twist_left = {};
    for (std::size_t k = 0; k < 3; ++k) cap.twist_by_bound[k] = std::copysign(1.0, twist) * n[k];
    result.torsion = twist_bound;
  }
  result.moment = sum({}, cap.roll_share, roll);
  result.moment = sum(result.moment, carried, n);
  return cap;
}

}  // namespace

ContactMoment<3> contact_moment(const ContactList<3>& list, std::size_t c,
                                const ContactPoint<3>& point, std::span<const double> coordinates,
                                std::size_t particles, const ContactLaw& law) {
  const auto rotation_of = [&](std::int32_t particle) {
    const double* theta = coordinates.data() + 3 * particles + static_cast<std::size_t>(particle);
    return quaternion_of({theta[0], theta[particles], theta[2 * particles]});
  };
  const Vec<3>& n = point.normal;
  const double d = point.distance;
  const double overlap = list.rest_of(c) - d;
  const double scale = stiffness_scale(overlap, law);
  const double bending = list.bending_stiffness[c] * scale;
  const double torsion = list.torsion_stiffness[c] * scale;
  const Quaternion relative = product(rotation_of(list.j[c]), conjugate(rotation_of(list.i[c])));
  Vec<3> kept{};
  for (std::size_t k = 0; k < 3; ++k) {
    kept[k] = start_scale(overlap, law) * list.start_moment[k][c];
  }
  const Vec<3> start = rotated(point.mean, kept);
  const double along = 2 * dot(n, relative.v);
  const Vec<3> sprung = sum(sum({}, 2 * bending, relative.v), (torsion - bending) * along, n);
  const Vec<3> trial = sum(start, -1, sprung);

  ContactMoment<3> result;
  const bool bonded = point.status == ContactStatus::bonded;
  const Cap cap = cap_of(result, n, trial, list.rolling_length[c] * point.normal_force,
                         list.twisting_length[c] * point.normal_force, bonded);
  Matrix3 left = cap.roll_left;
  add(left, 1, cap.twist_left);

  // Derivative of m* by the branch, then of the split along n.
  Matrix3 across{};  // dn by dl
  add_identity(across, 1 / d);
  add_outer(across, -1 / d, n, n);
  const Vec<3> relative_across = product<3>(across, relative.v);
  Matrix3 trial_by_branch{};
  add(trial_by_branch, -(torsion - bending) * along, across);
  add_outer(trial_by_branch, -2 * (torsion - bending), n, relative_across);
  if (law.hertzian()) {
    add_outer(trial_by_branch, 1 / overlap, sum(sum({}, 0.5, sprung), -0.25, start), n);
  }
  result.by_branch = product<3>(left, trial_by_branch);
  Matrix3 twist_by_normal{};  // of n (n.m*)
  add(twist_by_normal, dot(n, trial), across);
  add_outer(twist_by_normal, 1, n, product<3>(across, trial));
  if (cap.roll_share < 1) {
    Matrix3 roll_only{};
    add_identity(roll_only, cap.roll_share);
    add_outer(roll_only, -cap.roll_share, cap.roll_by_bound, cap.roll_by_bound);
    add_product(result.by_branch, -1, roll_only, twist_by_normal);
  } else {
    add(result.by_branch, -1, twist_by_normal);
  }
  if (cap.twist_share < 1) {
    add(result.by_branch, cap.twist_share * dot(n, trial), across);
  } else {
    add(result.by_branch, 1, twist_by_normal);
  }
  const double kn = list.normal_stiffness[c] * scale;
  add_outer(result.by_branch, -list.rolling_length[c] * kn, cap.roll_by_bound, n);
  add_outer(result.by_branch, -list.twisting_length[c] * kn, cap.twist_by_bound, n);

  Matrix3 springs{};
  add_identity(springs, bending);
  add_outer(springs, torsion - bending, n, n);
  Matrix3 relative_by_j{}, relative_by_i{};
  add_identity(relative_by_j, relative.s);
  add(relative_by_j, -1, cross_matrix(relative.v));
  add_identity(relative_by_i, -relative.s);
  add(relative_by_i, -1, cross_matrix(relative.v));
  const auto by_spin = [&](const Matrix3& mean_spin, double lever, const Matrix3& by) {
    Matrix3 trial_by{};
    add_product(trial_by, -lever, cross_matrix(start), mean_spin);
    add_product(trial_by, -1, springs, by);
    return product<3>(left, trial_by);
  };
  result.by_spin_i = by_spin(point.spin_i, list.lever_i[c], relative_by_i);
  result.by_spin_j = by_spin(point.spin_j, 1 - list.lever_i[c], relative_by_j);
  for (std::size_t m = 0; m < 3; ++m) {
    Vec<3> axis{};
    axis[m] = 1;
    const Vec<3> column = product<3>(left, rotated(point.mean, axis));
    for (std::size_t r = 0; r < 3; ++r) result.by_start[3 * r + m] = column[r];
  }
  return result;
}

}  // namespace grainlaw::core
