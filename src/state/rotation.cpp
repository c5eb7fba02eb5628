#include "state/rotation.hpp"

#include <cmath>
#include <cstddef>

namespace grainlaw {

namespace {

using Matrix = std::array<double, 4>;

Matrix product(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

Matrix inverse(const Matrix& a) {
  const double det = a[0] * a[3] - a[1] * a[2];
  return {a[3] / det, -a[1] / det, -a[2] / det, a[0] / det};
}

Matrix transpose(const Matrix& a) { return {a[0], a[2], a[1], a[3]}; }

}  // namespace

Increment2 split_rotation(const double* F, const double* committed) {
  const Matrix f{F[0], F[1], F[2], F[3]};
  const Matrix f0{committed[0], committed[1], committed[2], committed[3]};
  const Matrix df = product(f, inverse(f0));
  Increment2 increment;
  const double length = std::hypot(df[0] + df[3], df[2] - df[1]);
  const double c = (df[0] + df[3]) / length;
  const double s = (df[2] - df[1]) / length;
  increment.angle = std::atan2(s, c);
  increment.rotation = {c, -s, s, c};
  increment.stretch = product(transpose(increment.rotation), df);
  increment.target = product(increment.stretch, f0);
  return increment;
}

Increment2 without_rotation(const double* F, const double* committed) {
  Increment2 increment;
  increment.target = {F[0], F[1], F[2], F[3]};
  increment.rotation = {1, 0, 0, 1};
  increment.stretch =
      product(increment.target, inverse({committed[0], committed[1], committed[2], committed[3]}));
  return increment;
}

Matrix rotate_stress(const Increment2& increment, const Matrix& p) {
  return product(increment.rotation, p);
}

std::array<double, 16> rotate_tangent(const Increment2& increment, const double* committed,
                                      const Matrix& p, const std::array<double, 16>& tangent) {
  const Matrix f0{committed[0], committed[1], committed[2], committed[3]};
  const Matrix f0_inverse = inverse(f0);
  const Matrix& r = increment.rotation;
  const Matrix& u = increment.stretch;
  constexpr Matrix spin{0, -1, 1, 0};
  std::array<double, 16> result{};
  for (std::size_t k = 0; k < 4; ++k) {
    Matrix direction{};
    direction[k] = 1;
    // R^T d(dF) = omega spin U + dU with dU symmetric gives omega.
    const Matrix a = product(transpose(r), product(direction, f0_inverse));
    const double omega = (a[2] - a[1]) / (u[0] + u[3]);
    const Matrix spun = product(spin, u);
    Matrix stretch{};
    for (std::size_t m = 0; m < 4; ++m) stretch[m] = a[m] - omega * spun[m];
    const Matrix target = product(stretch, f0);
    Matrix change = product(spin, p);
    for (std::size_t m = 0; m < 4; ++m) {
      change[m] *= omega;
      for (std::size_t l = 0; l < 4; ++l) change[m] += tangent[m * 4 + l] * target[l];
    }
    const Matrix rotated = product(r, change);
    for (std::size_t m = 0; m < 4; ++m) result[m * 4 + k] = rotated[m];
  }
  return result;
}

}  // namespace grainlaw
