// The dense factorisation of a front's pivots, a diagonal block at a time, and solves with it.
#pragma once

#include "equilibrium/dense_panels.hpp"
#include "equilibrium/quad.hpp"

#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace grainlaw::dense {

// In place, by Gauss-Jordan with row pivoting. False when singular.
template <int b>
inline bool invert_with_pivoting(double* a) {
  constexpr std::size_t s = quad::width;
  double work[b][2 * b];
  for (std::size_t r = 0; r < b; ++r) {
    for (std::size_t c = 0; c < b; ++c) {
      work[r][c] = a[c * s + r];
      work[r][b + c] = r == c ? 1 : 0;
    }
  }
  for (std::size_t k = 0; k < b; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < b; ++r) {
      if (std::abs(work[r][k]) > std::abs(work[pivot][k])) pivot = r;
    }
    const double value = work[pivot][k];
    if (!(std::abs(value) > 0) || !std::isfinite(value)) return false;
    for (std::size_t c = 0; c < 2 * b; ++c) std::swap(work[k][c], work[pivot][c]);
    for (std::size_t c = 0; c < 2 * b; ++c) work[k][c] /= value;
    for (std::size_t r = 0; r < b; ++r) {
      if (r == k) continue;
      const double factor = work[r][k];
      for (std::size_t c = 0; c < 2 * b; ++c) work[r][c] -= factor * work[k][c];
    }
  }
  for (std::size_t r = 0; r < b; ++r) {
    for (std::size_t c = 0; c < b; ++c) a[c * s + r] = work[r][b + c];
  }
  return true;
}

// By cofactors where the determinant is not much smaller than the products it is made of.
constexpr double safe_determinant = 1e-5;

GRAINLAW_INLINE bool invert(double* a, std::integral_constant<int, 3>) {
  constexpr std::size_t s = quad::width;
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
  if (!(std::abs(determinant) > safe_determinant * size)) return invert_with_pivoting<3>(a);
  const double f = 1 / determinant;
  quad::store(a, quad::Lanes{c00, c10, c20, 0} * f);
  quad::store(
      a + s,
      quad::Lanes{a02 * a21 - a01 * a22, a00 * a22 - a02 * a20, a01 * a20 - a00 * a21, 0} * f);
  quad::store(
      a + 2 * s,
      quad::Lanes{a01 * a12 - a02 * a11, a02 * a10 - a00 * a12, a00 * a11 - a01 * a10, 0} * f);
  return true;
}

GRAINLAW_INLINE bool invert(double* a, std::integral_constant<int, 2>) {
  constexpr std::size_t s = quad::width;
  const double a00 = a[0], a10 = a[1], a01 = a[s], a11 = a[s + 1];
  const double determinant = a00 * a11 - a01 * a10;
  const double size = std::abs(a00 * a11) + std::abs(a01 * a10);
  if (!(std::abs(determinant) > safe_determinant * size)) return invert_with_pivoting<2>(a);
  const double f = 1 / determinant;
  quad::store(a, quad::Lanes{a11, -a10, 0, 0} * f);
  quad::store(a + s, quad::Lanes{-a01, a00, 0, 0} * f);
  return true;
}

template <std::size_t width>
using Bits = typename simd::Vector<width>::bits;

// All bits of the first `count` lanes.
template <std::size_t width>
GRAINLAW_INLINE Bits<width> first_lanes(std::size_t count) {
  static constexpr long long bits[2 * group] = {-1, -1, -1, -1, -1, -1, -1, -1};
  Bits<width> result;
  std::memcpy(&result, bits + group - std::min(count, width), sizeof result);
  return result;
}

// The pivots of a diagonal block of `rows` (whole groups), in place: upper factor, inverted pivots, and below them the lower factor, which
// `lower` has too, with zeros elsewhere. False when a pivot is singular.
template <std::size_t width, std::size_t b>
GRAINLAW_INLINE bool factorise_block(const Matrix& a, std::size_t nodes, std::size_t rows,
                                     const Matrix& lower) {
  using V = simd::Lanes<width>;
  const std::size_t columns = b * nodes;
  for (std::size_t p = 0; p < columns; p += b) {
    alignas(32) double pivot[b * quad::width] = {};
    for (std::size_t c = 0; c < b; ++c) {
      for (std::size_t r = 0; r < b; ++r) pivot[c * quad::width + r] = a.column(p + c)[p + r];
    }
    if (!invert(pivot, std::integral_constant<int, b>{})) return false;
    for (std::size_t r = 0; r < rows; r += width) {
      V product[b];
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
        product[c] = load<width>(a.column(p) + r) * pivot[c * quad::width];
#pragma GCC unroll 3
        for (std::size_t k = 1; k < b; ++k) {
          product[c] += load<width>(a.column(p + k) + r) * pivot[c * quad::width + k];
        }
      }
      const Bits<width> found = first_lanes<width>(std::max(r, p + b) - r);
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
        double* const column = a.column(p + c) + r;
        const auto below = (Bits<width>)product[c] & ~found;
        store(lower.column(p + c) + r, (V)below);
        store(column, (V)(below | ((Bits<width>)load<width>(column) & found)));
      }
    }
    for (std::size_t c = 0; c < b; ++c) {
      for (std::size_t r = 0; r < b; ++r) a.column(p + c)[p + r] = pivot[c * quad::width + r];
    }
    const std::size_t first = p + b < columns ? (p + b) / width * width : rows;
    for (std::size_t c = p + b; c < columns; ++c) {
      const double* const x = a.column(c) + p;
      double factor[b];
#pragma GCC unroll 3
      for (std::size_t k = 0; k < b; ++k) factor[k] = x[k];
      for (std::size_t r = first; r < rows; r += width) {
        V sum = load<width>(a.column(c) + r);
#pragma GCC unroll 3
        for (std::size_t k = 0; k < b; ++k) sum -= load<width>(lower.column(p + k) + r) * factor[k];
        store(a.column(c) + r, sum);
      }
    }
  }
  return true;
}

// x <- L^-1 x, of `count` columns with `groups` groups of rows; L is `lower` and ones.
template <std::size_t width, std::size_t b, std::size_t groups, std::size_t count>
GRAINLAW_INLINE void solve_lower_tile(const Matrix& x, const Matrix& lower, std::size_t pivots) {
  using V = simd::Lanes<width>;
  constexpr std::size_t vectors = groups * group / width;
  V sum[count][vectors];
#pragma GCC unroll 4
  for (std::size_t j = 0; j < count; ++j) {
#pragma GCC unroll 12
    for (std::size_t v = 0; v < vectors; ++v) sum[j][v] = load<width>(x.column(j) + width * v);
  }
#pragma GCC unroll 12
  for (std::size_t p = 0; p + b <= groups * group; p += b) {
    // These are found: what is below them takes them from memory.
#pragma GCC unroll 4
    for (std::size_t j = 0; j < count; ++j) {
#pragma GCC unroll 12
      for (std::size_t v = p / width; v <= (p + b - 1) / width; ++v) {
        store(x.column(j) + width * v, sum[j][v]);
      }
    }
    if (p + b >= pivots) break;
#pragma GCC unroll 3
    for (std::size_t k = p; k < p + b; ++k) {
      double right[count];
#pragma GCC unroll 4
      for (std::size_t j = 0; j < count; ++j) right[j] = x.column(j)[k];
#pragma GCC unroll 12
      for (std::size_t v = (p + b) / width; v < vectors; ++v) {
        const V left = load<width>(lower.column(k) + width * v);
#pragma GCC unroll 4
        for (std::size_t j = 0; j < count; ++j) sum[j][v] -= left * right[j];
      }
    }
  }
}

template <std::size_t width, std::size_t b, std::size_t groups>
GRAINLAW_INLINE void solve_lower_columns(const Matrix& x, const Matrix& lower, std::size_t pivots,
                                         std::size_t columns) {
  constexpr std::size_t count = width == group ? 4 : 2;
  std::size_t j = 0;
  for (; j + count <= columns; j += count) {
    solve_lower_tile<width, b, groups, count>(x.from(0, j), lower, pivots);
  }
  for (; j < columns; ++j) solve_lower_tile<width, b, groups, 1>(x.from(0, j), lower, pivots);
}

template <std::size_t width, std::size_t b>
GRAINLAW_INLINE void solve_lower(const Matrix& x, const Matrix& lower, std::size_t pivots,
                                 std::size_t rows, std::size_t columns) {
  if (pivots == b) return;
  if (rows == group) return solve_lower_columns<width, b, 1>(x, lower, pivots, columns);
  if (rows == 2 * group) return solve_lower_columns<width, b, 2>(x, lower, pivots, columns);
  solve_lower_columns<width, b, 3>(x, lower, pivots, columns);
}

// x <- x U^-1 of whole groups of rows; U has its pivots inverted.
template <std::size_t width, std::size_t b>
GRAINLAW_INLINE void solve_upper(const Matrix& x, const Matrix& upper, std::size_t pivots,
                                 std::size_t rows) {
  using V = simd::Lanes<width>;
  constexpr std::size_t vectors = group / width;
  for (std::size_t r = 0; r < rows; r += group) {
    const Matrix at = x.from(r, 0);
    for (std::size_t p = 0; p < pivots; p += b) {
      V sum[b][vectors];
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 4
        for (std::size_t v = 0; v < vectors; ++v) {
          sum[c][v] = load<width>(at.column(p + c) + width * v);
        }
      }
      for (std::size_t k = 0; k < p; ++k) {
#pragma GCC unroll 4
        for (std::size_t v = 0; v < vectors; ++v) {
          const V left = load<width>(at.column(k) + width * v);
#pragma GCC unroll 3
          for (std::size_t c = 0; c < b; ++c) sum[c][v] -= left * upper.column(p + c)[k];
        }
      }
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
        const double* const inverse = upper.column(p + c) + p;
#pragma GCC unroll 4
        for (std::size_t v = 0; v < vectors; ++v) {
          V product = sum[0][v] * inverse[0];
#pragma GCC unroll 3
          for (std::size_t k = 1; k < b; ++k) product += sum[k][v] * inverse[k];
          store(at.column(p + c) + width * v, product);
        }
      }
    }
  }
}

}  // namespace grainlaw::dense
