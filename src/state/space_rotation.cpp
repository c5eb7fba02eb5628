// Rotations in space.
#include "state/rotation.hpp"

#include <cmath>
#include <cstddef>

namespace grainlaw::core {

namespace {

// R of a = R U by Newton's iteration for the polar factor (Higham 1986), quadratic for det a > 0.
Tensor<3> polar_rotation(const Tensor<3>& a) {
  constexpr int most_steps = 60;
  constexpr double settled = 1e-16;
  Tensor<3> r = a;
  for (int step = 0; step < most_steps; ++step) {
    const Tensor<3> other = transpose<3>(inverse<3>(r));
    double change = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      const double next = 0.5 * (r[k] + other[k]);
      change = std::max(change, std::abs(next - r[k]));
      r[k] = next;
    }
    if (!(change > settled)) break;
  }
  return r;
}

Vec<3> rotation_vector(const Tensor<3>& r) {
  const Vec<3> axis{0.5 * (r[7] - r[5]), 0.5 * (r[2] - r[6]), 0.5 * (r[3] - r[1])};
  const double sine = length<3>(axis);
  const double scale = sine > 0 ? std::atan2(sine, 0.5 * (trace<3>(r) - 1)) / sine : 1;
  return {scale * axis[0], scale * axis[1], scale * axis[2]};
}

Tensor<3> skew(const Vec<3>& axis) {
  return {0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0};
}

}  // namespace

template <>
SplitIncrement<3> split_rotation<3>(const Tensor<3>& F, const Tensor<3>& committed) {
  const Tensor<3> df = product<3>(F, inverse<3>(committed));
  SplitIncrement<3> increment;
  increment.rotation = polar_rotation(df);
  increment.rotation_vector = rotation_vector(increment.rotation);
  increment.stretch = product<3>(transpose<3>(increment.rotation), df);
  increment.target = product<3>(increment.stretch, committed);
  return increment;
}

template <>
Tensor4<3> rotate_tangent<3>(const SplitIncrement<3>& increment, const Tensor<3>& committed,
                             const Tensor<3>& p, const Tensor4<3>& tangent) {
  constexpr std::size_t n = squared<3>;
  const Tensor<3> f0_inverse = inverse<3>(committed);
  const Tensor<3>& r = increment.rotation;
  const Tensor<3>& u = increment.stretch;
  // Matrix from the axis of Omega to that of Omega U + U Omega.
  Tensor<3> of_axis{};
  for (std::size_t k = 0; k < n; ++k) of_axis[k] = -u[k];
  for (std::size_t k = 0; k < 3; ++k) of_axis[4 * k] += trace<3>(u);
  const Tensor<3> to_axis = inverse<3>(of_axis);
  Tensor4<3> result{};
  for (std::size_t k = 0; k < n; ++k) {
    Tensor<3> direction{};
    direction[k] = 1;
    // Omega follows from R^T d(dF) = Omega U + dU with dU symmetric.
    const Tensor<3> a = product<3>(transpose<3>(r), product<3>(direction, f0_inverse));
    const Vec<3> axis = product<3>(to_axis, Vec<3>{a[7] - a[5], a[2] - a[6], a[3] - a[1]});
    const Tensor<3> spin = skew(axis);
    const Tensor<3> spun = product<3>(spin, u);
    Tensor<3> stretch{};
    for (std::size_t m = 0; m < n; ++m) stretch[m] = a[m] - spun[m];
    const Tensor<3> target = product<3>(stretch, committed);
    Tensor<3> change = product<3>(spin, p);
    for (std::size_t m = 0; m < n; ++m) {
      for (std::size_t l = 0; l < n; ++l) change[m] += tangent[m * n + l] * target[l];
    }
    const Tensor<3> rotated = product<3>(r, change);
    for (std::size_t m = 0; m < n; ++m) result[m * n + k] = rotated[m];
  }
  return result;
}

}  // namespace grainlaw::core
