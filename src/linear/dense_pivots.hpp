// Dense factorisation of a front's pivots by diagonal blocks, and solves with it.
#pragma once

#include "linear/columns.hpp"
#include "linear/dense_block.hpp"
#include "linear/dense_panels.hpp"

#include <cstring>

namespace grainlaw::core::dense {

template <std::size_t width>
using Bits = typename simd::Vector<width>::bits;

// Mask of the first `count` lanes.
template <std::size_t width>
GRAINLAW_INLINE Bits<width> first_lanes(std::size_t count) {
  static constexpr long long bits[2 * group] = {-1, -1, -1, -1, -1, -1, -1, -1};
  Bits<width> result;
  std::memcpy(&result, bits + group - std::min(count, width), sizeof result);
  return result;
}

// Factorises the pivots of a diagonal part of `rows` (whole groups) in place: upper factor,
// factorised pivots, lower factor. `lower` gets the lower factor too, zeros elsewhere. Returns
// false if a pivot is singular.
template <std::size_t width, std::size_t b>
GRAINLAW_INLINE bool factorise_diagonal(const Matrix& a, std::size_t nodes, std::size_t rows,
                                        Pivot* kept, const Matrix& lower) {
  using V = simd::Lanes<width>;
  const std::size_t columns = b * nodes;
  for (std::size_t p = 0; p < columns; p += b) {
    constexpr std::size_t apart = rows_of(b);
    alignas(64) double pivot[b * apart] = {};
    for (std::size_t c = 0; c < b; ++c) {
      for (std::size_t r = 0; r < b; ++r) pivot[c * apart + r] = a.column(p + c)[p + r];
    }
    const Pivot& how = *kept;
    if (!factorise<b>(pivot, *kept++)) return false;
    for (std::size_t r = 0; r < rows; r += width) {
      V x[b];
#pragma GCC unroll 6
      for (std::size_t c = 0; c < b; ++c) x[c] = load<width>(a.column(p + c) + r);
      const Bits<width> found = first_lanes<width>(std::max(r, p + b) - r);
      divide_rows<b>(x, pivot, apart, how, [&](std::size_t c, const V& value) GRAINLAW_INLINED {
        double* const column = a.column(p + c) + r;
        const auto below = (Bits<width>)value & ~found;
        store(lower.column(p + c) + r, (V)below);
        store(column, (V)(below | ((Bits<width>)load<width>(column) & found)));
      });
    }
    for (std::size_t c = 0; c < b; ++c) {
      for (std::size_t r = 0; r < b; ++r) a.column(p + c)[p + r] = pivot[c * apart + r];
    }
    const std::size_t first = p + b < columns ? (p + b) / width * width : rows;
    for (std::size_t c = p + b; c < columns; ++c) {
      const double* const x = a.column(c) + p;
      double factor[b];
#pragma GCC unroll 6
      for (std::size_t k = 0; k < b; ++k) factor[k] = x[k];
      for (std::size_t r = first; r < rows; r += width) {
        V sum = load<width>(a.column(c) + r);
#pragma GCC unroll 6
        for (std::size_t k = 0; k < b; ++k) sum -= load<width>(lower.column(p + k) + r) * factor[k];
        store(a.column(c) + r, sum);
      }
    }
  }
  return true;
}

// Replaces x by L^-1 x, for `count` columns of `groups` groups; L is `lower` plus the identity.
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
    // These rows are final; the rows below read them from memory.
#pragma GCC unroll 4
    for (std::size_t j = 0; j < count; ++j) {
#pragma GCC unroll 12
      for (std::size_t v = p / width; v <= (p + b - 1) / width; ++v) {
        store(x.column(j) + width * v, sum[j][v]);
      }
    }
    if (p + b >= pivots) break;
#pragma GCC unroll 6
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

// Replaces x by x U^-1, for whole groups of rows; the pivots of U are factorised.
template <std::size_t width, std::size_t b>
GRAINLAW_INLINE void solve_upper(const Matrix& x, const Matrix& upper, const Pivot* kept,
                                 std::size_t pivots, std::size_t rows) {
  using V = simd::Lanes<width>;
  constexpr std::size_t vectors = group / width;
  for (std::size_t r = 0; r < rows; r += group) {
    const Matrix at = x.from(r, 0);
    for (std::size_t p = 0; p < pivots; p += b) {
      V sum[b][vectors];
#pragma GCC unroll 6
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
#pragma GCC unroll 6
          for (std::size_t c = 0; c < b; ++c) sum[c][v] -= left * upper.column(p + c)[k];
        }
      }
#pragma GCC unroll 4
      for (std::size_t v = 0; v < vectors; ++v) {
        V right[b];
#pragma GCC unroll 6
        for (std::size_t c = 0; c < b; ++c) right[c] = sum[c][v];
        divide_rows<b>(right, upper.column(p) + p, upper.stride, kept[p / b],
                       [&](std::size_t c, const V& value)
                           GRAINLAW_INLINED { store(at.column(p + c) + width * v, value); });
      }
    }
  }
}

}  // namespace grainlaw::core::dense
