// Diagonal block of a front: factorisation and division. Columns are rows_of(b) apart in a block,
// further in a panel.
#pragma once

#include "linear/columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace grainlaw::core::dense {

// Form of a factorised block: its inverse or, where that would lose digits, triangular factors of
// its rows in this order. The diagonal of the upper factor is inverted.
struct Pivot {
  bool triangular = false;
  std::int8_t row[6] = {0, 1, 2, 3, 4, 5};
};

// Least ratio of a determinant to the products in it for a safe inverse [-]. Particles that move in
// one direction at constant forces fall below it.
constexpr double safe_determinant = 1e-2;

// Inverts by cofactors. Returns false and changes nothing where that would lose digits.
GRAINLAW_INLINE bool invert(double* a, std::integral_constant<std::size_t, 3>) {
  constexpr std::size_t s = rows_of(3);
  const double a00 = a[0], a10 = a[1], a20 = a[2];
  const double a01 = a[s], a11 = a[s + 1], a21 = a[s + 2];
  const double a02 = a[2 * s], a12 = a[2 * s + 1], a22 = a[2 * s + 2];
  const double c00 = a11 * a22 - a12 * a21;
  const double c10 = a12 * a20 - a10 * a22;
  const double c20 = a10 * a21 - a11 * a20;
  const double determinant = a00 * c00 + a01 * c10 + a02 * c20;
  const double size = std::abs(a00) * (std::abs(a11 * a22) + std::abs(a12 * a21)) +
                      std::abs(a01) * (std::abs(a12 * a20) + std::abs(a10 * a22)) +
                      std::abs(a02) * (std::abs(a10 * a21) + std::abs(a11 * a20));
  if (!(std::abs(determinant) > safe_determinant * size)) return false;
  const double f = 1 / determinant;
  simd::store(a, simd::Lanes<4>{c00, c10, c20, 0} * f);
  simd::store(
      a + s,
      simd::Lanes<4>{a02 * a21 - a01 * a22, a00 * a22 - a02 * a20, a01 * a20 - a00 * a21, 0} * f);
  simd::store(
      a + 2 * s,
      simd::Lanes<4>{a01 * a12 - a02 * a11, a02 * a10 - a00 * a12, a00 * a11 - a01 * a10, 0} * f);
  return true;
}

GRAINLAW_INLINE bool invert(double* a, std::integral_constant<std::size_t, 2>) {
  constexpr std::size_t s = rows_of(2);
  const double a00 = a[0], a10 = a[1], a01 = a[s], a11 = a[s + 1];
  const double determinant = a00 * a11 - a01 * a10;
  const double size = std::abs(a00 * a11) + std::abs(a01 * a10);
  if (!(std::abs(determinant) > safe_determinant * size)) return false;
  const double f = 1 / determinant;
  simd::store(a, simd::Lanes<4>{a11, -a10, 0, 0} * f);
  simd::store(a + s, simd::Lanes<4>{-a01, a00, 0, 0} * f);
  return true;
}

// Factorises into triangles with row pivoting relative to the rows, since translations and
// rotations differ in unit. Returns false if singular.
template <std::size_t b>
inline bool triangulate(double* a, Pivot& pivot) {
  constexpr std::size_t s = rows_of(b);
  double largest[b] = {};
  for (std::size_t r = 0; r < b; ++r) {
    for (std::size_t c = 0; c < b; ++c) largest[r] = std::max(largest[r], std::abs(a[c * s + r]));
    pivot.row[r] = static_cast<std::int8_t>(r);
  }
  for (std::size_t k = 0; k < b; ++k) {
    const auto share = [&](std::size_t r) { return std::abs(a[k * s + r]) / largest[r]; };
    std::size_t best = k;
    for (std::size_t r = k + 1; r < b; ++r) {
      if (share(r) > share(best)) best = r;
    }
    const double value = a[k * s + best];
    if (!(std::abs(value) > 0) || !std::isfinite(value)) return false;
    for (std::size_t c = 0; c < b; ++c) std::swap(a[c * s + k], a[c * s + best]);
    std::swap(largest[k], largest[best]);
    std::swap(pivot.row[k], pivot.row[best]);
    a[k * s + k] = 1 / value;
    for (std::size_t r = k + 1; r < b; ++r) {
      a[k * s + r] *= a[k * s + k];
      for (std::size_t c = k + 1; c < b; ++c) a[c * s + r] -= a[k * s + r] * a[c * s + k];
    }
  }
  return true;
}

// Factorises in place. Returns false if singular.
template <std::size_t b>
GRAINLAW_INLINE bool factorise(double* a, Pivot& pivot) {
  if constexpr (b <= 3) {
    pivot.triangular = !invert(a, std::integral_constant<std::size_t, b>{});
  } else {
    pivot.triangular = true;
  }
  return !pivot.triangular || triangulate<b>(a, pivot);
}

// Computes x A^-1 of rows x, one component per entry; put(c, value) takes the results.
template <std::size_t b, class Value, class Put>
GRAINLAW_INLINE void divide_rows(Value (&x)[b], const double* a, std::size_t stride,
                                 const Pivot& pivot, const Put& put) {
  if (!pivot.triangular) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) {
      Value product = x[0] * a[c * stride];
#pragma GCC unroll 6
      for (std::size_t k = 1; k < b; ++k) product += x[k] * a[c * stride + k];
      put(c, product);
    }
    return;
  }
#pragma GCC unroll 6
  for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < c; ++k) x[c] -= x[k] * a[c * stride + k];
    x[c] *= a[c * stride + c];
  }
#pragma GCC unroll 6
  for (std::size_t done = 0; done < b; ++done) {
    const std::size_t c = b - 1 - done;
#pragma GCC unroll 6
    for (std::size_t k = c + 1; k < b; ++k) x[c] -= x[k] * a[c * stride + k];
    put(static_cast<std::size_t>(pivot.row[c]), x[c]);
  }
}

// Computes A^-1 x with triangular factors; take(c) gives the components of x.
template <std::size_t b, class Value, class Take>
GRAINLAW_INLINE void divide_column(Value (&x)[b], const double* a, std::size_t stride,
                                   const Pivot& pivot, const Take& take) {
#pragma GCC unroll 6
  for (std::size_t r = 0; r < b; ++r) {
    x[r] = take(static_cast<std::size_t>(pivot.row[r]));
#pragma GCC unroll 6
    for (std::size_t k = 0; k < r; ++k) x[r] -= a[k * stride + r] * x[k];
  }
#pragma GCC unroll 6
  for (std::size_t done = 0; done < b; ++done) {
    const std::size_t r = b - 1 - done;
#pragma GCC unroll 6
    for (std::size_t k = r + 1; k < b; ++k) x[r] -= a[k * stride + r] * x[k];
    x[r] *= a[r * stride + r];
  }
}

}  // namespace grainlaw::core::dense
