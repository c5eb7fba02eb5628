// Rotations in the plane by one angle.
#include "state/rotation.hpp"

#include <cmath>
#include <cstddef>

namespace grainlaw::core {

template <>
SplitIncrement<2> split_rotation<2>(const Tensor<2>& F, const Tensor<2>& committed) {
  const Tensor<2> df = product<2>(F, inverse<2>(committed));
  SplitIncrement<2> increment;
  const double length = std::hypot(df[0] + df[3], df[2] - df[1]);
  const double c = (df[0] + df[3]) / length;
  const double s = (df[2] - df[1]) / length;
  increment.rotation_vector = {std::atan2(s, c)};
  increment.rotation = {c, -s, s, c};
  increment.stretch = product<2>(transpose<2>(increment.rotation), df);
  increment.target = product<2>(increment.stretch, committed);
  return increment;
}

template <>
Tensor4<2> rotate_tangent<2>(const SplitIncrement<2>& increment, const Tensor<2>& committed,
                             const Tensor<2>& p, const Tensor4<2>& tangent) {
  const Tensor<2> f0_inverse = inverse<2>(committed);
  const Tensor<2>& r = increment.rotation;
  const Tensor<2>& u = increment.stretch;
  constexpr Tensor<2> spin{0, -1, 1, 0};
  Tensor4<2> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    Tensor<2> direction{};
    direction[k] = 1;
    // omega follows from R^T d(dF) = omega spin U + dU with dU symmetric.
    const Tensor<2> a = product<2>(transpose<2>(r), product<2>(direction, f0_inverse));
    const double omega = (a[2] - a[1]) / (u[0] + u[3]);
    const Tensor<2> spun = product<2>(spin, u);
    Tensor<2> stretch{};
    for (std::size_t m = 0; m < 4; ++m) stretch[m] = a[m] - omega * spun[m];
    const Tensor<2> target = product<2>(stretch, committed);
    Tensor<2> change = product<2>(spin, p);
    for (std::size_t m = 0; m < 4; ++m) {
      change[m] *= omega;
      for (std::size_t l = 0; l < 4; ++l) change[m] += tangent[m * 4 + l] * target[l];
    }
    const Tensor<2> rotated = product<2>(r, change);
    for (std::size_t m = 0; m < 4; ++m) result[m * 4 + k] = rotated[m];
  }
  return result;
}

}  // namespace grainlaw::core
