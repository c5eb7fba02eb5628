// Vectors and second-order tensors in two and three dimensions. Tensors are row-major.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace grainlaw::core {

template <int D>
inline constexpr std::size_t squared = static_cast<std::size_t>(D) * D;

template <int D>
using Vec = std::array<double, static_cast<std::size_t>(D)>;
template <int D>
using Tensor = std::array<double, squared<D>>;  // a[D i + j]
template <int D>
using Tensor4 = std::array<double, squared<D> * squared<D>>;  // a[(D i + j) D^2 + D k + l]

template <int D>
constexpr Tensor<D> identity() {
  Tensor<D> result{};
  for (std::size_t k = 0; k < D; ++k) result[(D + 1) * k] = 1;
  return result;
}

// First D^2 numbers of an array with the capacity of three dimensions.
template <int D, std::size_t size>
Tensor<D> tensor_of(const std::array<double, size>& values) {
  static_assert(size >= squared<D>);
  Tensor<D> result{};
  for (std::size_t k = 0; k < squared<D>; ++k) result[k] = values[k];
  return result;
}
template <int D>
Tensor<D> tensor_of(const double* values) {
  Tensor<D> result{};
  for (std::size_t k = 0; k < squared<D>; ++k) result[k] = values[k];
  return result;
}

// sum_k a_k b_k over D entries; those of b are `stride` apart.
template <int D>
[[gnu::always_inline]] inline double dot(const double* a, const double* b, std::size_t stride = 1) {
  if constexpr (D == 2) {
    return a[0] * b[0] + a[1] * b[stride];
  } else {
    return a[0] * b[0] + a[1] * b[stride] + a[2] * b[2 * stride];
  }
}

template <int D>
[[gnu::always_inline]] inline Vec<D> product(const Tensor<D>& a, const Vec<D>& x) {
  Vec<D> result{};
  for (std::size_t k = 0; k < D; ++k) result[k] = dot<D>(a.data() + D * k, x.data());
  return result;
}

template <int D>
Tensor<D> product(const Tensor<D>& a, const Tensor<D>& b) {
  Tensor<D> result{};
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < D; ++j) {
      result[D * i + j] = dot<D>(a.data() + D * i, b.data() + j, D);
    }
  }
  return result;
}

// a + share (b - a).
template <int D>
Tensor<D> between(const Tensor<D>& a, const Tensor<D>& b, double share) {
  Tensor<D> f{};
  for (std::size_t k = 0; k < squared<D>; ++k) f[k] = a[k] + share * (b[k] - a[k]);
  return f;
}

template <int D>
Tensor<D> transpose(const Tensor<D>& a) {
  Tensor<D> result{};
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < D; ++j) result[D * i + j] = a[D * j + i];
  }
  return result;
}

template <int D>
double trace(const Tensor<D>& a) {
  double sum = a[0];
  for (std::size_t k = 1; k < D; ++k) sum += a[(D + 1) * k];
  return sum;
}

template <int D>
inline double determinant(const double* a) {
  if constexpr (D == 2) {
    return a[0] * a[3] - a[1] * a[2];
  } else {
    return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
           a[2] * (a[3] * a[7] - a[4] * a[6]);
  }
}
template <int D>
double determinant(const Tensor<D>& a) {
  return determinant<D>(a.data());
}

// Inverse by cofactors; not finite for a singular tensor.
template <int D>
Tensor<D> inverse(const Tensor<D>& a) {
  const double det = determinant<D>(a.data());
  if constexpr (D == 2) {
    return {a[3] / det, -a[1] / det, -a[2] / det, a[0] / det};
  } else {
    return {(a[4] * a[8] - a[5] * a[7]) / det, (a[2] * a[7] - a[1] * a[8]) / det,
            (a[1] * a[5] - a[2] * a[4]) / det, (a[5] * a[6] - a[3] * a[8]) / det,
            (a[0] * a[8] - a[2] * a[6]) / det, (a[2] * a[3] - a[0] * a[5]) / det,
            (a[3] * a[7] - a[4] * a[6]) / det, (a[1] * a[6] - a[0] * a[7]) / det,
            (a[0] * a[4] - a[1] * a[3]) / det};
  }
}

template <int D>
double length(const Vec<D>& x) {
  if constexpr (D == 2) {
    return std::hypot(x[0], x[1]);
  } else {
    return std::hypot(x[0], x[1], x[2]);
  }
}

template <int D>
[[gnu::always_inline]] inline double square(const Vec<D>& x) {
  return dot<D>(x.data(), x.data());
}

// Eigenvalues of a symmetric tensor, ascending (Smith 1961).
inline Vec<3> principal_values(const Tensor<3>& a) {
  const double mean = trace<3>(a) / 3;
  Tensor<3> deviator = a;
  for (std::size_t k = 0; k < 3; ++k) deviator[4 * k] -= mean;
  double squares = 0;
  for (const double value : deviator) squares += value * value;
  const double p = std::sqrt(squares / 6);
  if (!(p > 0)) return {mean, mean, mean};
  for (double& value : deviator) value /= p;
  const double r = std::clamp(0.5 * determinant<3>(deviator), -1.0, 1.0);
  const double angle = std::acos(r) / 3;
  const double third = 2 * std::numbers::pi / 3;
  const double largest = mean + 2 * p * std::cos(angle);
  const double least = mean + 2 * p * std::cos(angle + third);
  return {least, 3 * mean - largest - least, largest};
}

// Largest singular value: the largest stretch, invariant under rotations.
template <int D>
double largest_singular_value(const Tensor<D>& a) {
  if constexpr (D == 2) {
    return 0.5 * (std::hypot(a[0] + a[3], a[1] - a[2]) + std::hypot(a[0] - a[3], a[1] + a[2]));
  } else {
    return std::sqrt(std::max(0.0, principal_values(product<3>(transpose<3>(a), a))[2]));
  }
}

}  // namespace grainlaw::core
