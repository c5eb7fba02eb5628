// Rotations of spheres: unit quaternions stored behind the positions.
#pragma once

#include "contact/sphere_point.hpp"
#include "increment/configuration.hpp"
#include "state/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grainlaw::core {

// Quaternion of a rotation matrix, from its largest component first, so that no digits cancel.
inline Quaternion quaternion_of(const Matrix3& r) {
  const double squares[4] = {1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8],
                             1 - r[0] - r[4] + r[8]};
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    if (squares[k] > squares[largest]) largest = k;
  }
  const double twice = std::sqrt(squares[largest]);
  const double f = 0.5 / twice;
  const Vec<3> odd{r[7] - r[5], r[2] - r[6], r[3] - r[1]};
  if (largest == 0) return {0.5 * twice, {f * odd[0], f * odd[1], f * odd[2]}};
  Quaternion q;
  const std::size_t a = largest - 1;
  q.s = f * odd[a];
  for (std::size_t b = 0; b < 3; ++b) {
    q.v[b] = b == a ? 0.5 * twice : f * (r[3 * a + b] + r[3 * b + a]);
  }
  return q;
}

inline Quaternion rotation_at(const std::vector<double>& coordinates, std::size_t n,
                              std::size_t p) {
  return {coordinates[3 * n + p],
          {coordinates[4 * n + p], coordinates[5 * n + p], coordinates[6 * n + p]}};
}

inline void add_rotation(const SplitIncrement<3>& increment, std::size_t n,
                         std::vector<double>& z) {
  if (z.size() == 3 * n) return;
  const Quaternion rotation = quaternion_of(increment.rotation);
  for (std::size_t p = 0; p < n; ++p) {
    const Quaternion q = product(rotation, rotation_at(z, n, p));
    z[3 * n + p] = q.s;
    for (std::size_t k = 0; k < 3; ++k) z[(4 + k) * n + p] = q.v[k];
  }
}

inline void rotate_springs(const SplitIncrement<3>& increment, Configuration<3>& configuration) {
  for (auto& contact : configuration.contacts) {
    contact.tangential_force = product<3>(increment.rotation, contact.tangential_force);
  }
  auto& moments = configuration.moments;
  for (std::size_t m = 0; m < moments.size(); m += 3) {
    const Vec<3> rotated =
        product<3>(increment.rotation, Vec<3>{moments[m], moments[m + 1], moments[m + 2]});
    std::copy(rotated.begin(), rotated.end(), moments.begin() + static_cast<std::ptrdiff_t>(m));
  }
}

// Replaces rotations since F = I by Gibbs vectors since `from`, without the rotation of the
// increment.
inline void to_relative_rotation(const SplitIncrement<3>& increment, const Configuration<3>& from,
                                 std::size_t n, std::vector<double>& z) {
  const bool rotating = z.size() > 3 * n;
  const std::vector<double> rotated(z);
  z.resize(6 * n);
  const Quaternion back = conjugate(quaternion_of(increment.rotation));
  for (std::size_t p = 0; p < n; ++p) {
    Quaternion q;
    if (rotating) {
      q = product(product(back, rotation_at(rotated, n, p)),
                  conjugate(rotation_at(from.coordinates, n, p)));
    }
    for (std::size_t k = 0; k < 3; ++k) z[(3 + k) * n + p] = 2 * q.v[k] / q.s;
  }
}

}  // namespace grainlaw::core
