// Dense panels of a front, column-major: their shape, and products in registers.
#pragma once

#include "base/simd.hpp"

#include <algorithm>
#include <cstddef>

namespace grainlaw::core::dense {

// Rows per group, the lanes of the widest registers. The last group is padded with zeros, so that
// results do not depend on the lanes.
constexpr std::size_t group = 8;
constexpr std::size_t block = 24;  // pivots at a time: whole nodes and whole groups

constexpr std::size_t whole_groups(std::size_t rows) { return (rows + group - 1) / group * group; }

// Shape of a front with pivots first. Panels: the pivots' rows with all columns; the other rows
// with the pivots' columns; the Schur complement of the others.
struct Shape {
  std::size_t components, pivots;      // unknowns of a node; nodes
  std::size_t eliminated, others;      // unknowns
  std::size_t pivot_rows, other_rows;  // from column to column

  Shape(std::size_t pivot_nodes, std::size_t other_nodes, std::size_t unknowns)
      : components(unknowns),
        pivots(pivot_nodes),
        eliminated(unknowns * pivot_nodes),
        others(unknowns * other_nodes),
        pivot_rows(whole_groups(eliminated)),
        other_rows(whole_groups(others)) {}

  [[nodiscard]] std::size_t other_panel() const { return pivot_rows * (eliminated + others); }
  [[nodiscard]] std::size_t panel_size() const { return other_panel() + other_rows * eliminated; }
  [[nodiscard]] std::size_t left_size() const { return other_rows * others; }
  // Approximate cost of a front of this shape [cycles], measured with registers of eight lanes.
  [[nodiscard]] double cost() const {
    constexpr double front = 250, panel_entry = 0.4, left_entry = 0.6, product = 1.0 / 16;
    const auto panel = static_cast<double>(panel_size());
    const auto left = static_cast<double>(left_size());
    return front + panel_entry * panel + left_entry * left +
           product * static_cast<double>(eliminated) * (panel + left);
  }
  // Position of block (row, column), counted in nodes, one of which is a pivot.
  [[nodiscard]] std::size_t offset(std::size_t row, std::size_t column) const {
    const std::size_t to = components * column;
    return row < pivots ? pivot_rows * to + components * row
                        : other_panel() + other_rows * to + components * (row - pivots);
  }
};

using simd::load;
using simd::store;

struct Matrix {
  double* at;
  std::size_t stride;  // from column to column

  GRAINLAW_INLINE double* column(std::size_t c) const { return at + c * stride; }
  GRAINLAW_INLINE Matrix from(std::size_t row, std::size_t c) const {
    return {at + row + c * stride, stride};
  }
};

// Subtracts a x from c, in tiles of vectors x columns registers; a has `inner` columns.
template <std::size_t width, std::size_t vectors, std::size_t columns>
GRAINLAW_INLINE void subtract_tile(const Matrix& c, const Matrix& a, const Matrix& x,
                                   std::size_t inner) {
  using V = simd::Lanes<width>;
  V sum[columns][vectors];
#pragma GCC unroll 6
  for (std::size_t j = 0; j < columns; ++j) {
#pragma GCC unroll 4
    for (std::size_t v = 0; v < vectors; ++v) sum[j][v] = load<width>(c.column(j) + width * v);
  }
  for (std::size_t k = 0; k < inner; ++k) {
    V left[vectors];
#pragma GCC unroll 4
    for (std::size_t v = 0; v < vectors; ++v) left[v] = load<width>(a.column(k) + width * v);
#pragma GCC unroll 6
    for (std::size_t j = 0; j < columns; ++j) {
      const double right = x.column(j)[k];
#pragma GCC unroll 4
      for (std::size_t v = 0; v < vectors; ++v) sum[j][v] -= left[v] * right;
    }
  }
#pragma GCC unroll 6
  for (std::size_t j = 0; j < columns; ++j) {
#pragma GCC unroll 4
    for (std::size_t v = 0; v < vectors; ++v) store(c.column(j) + width * v, sum[j][v]);
  }
}

template <std::size_t width, std::size_t columns>
GRAINLAW_INLINE void subtract_columns(const Matrix& c, const Matrix& a, const Matrix& x,
                                      std::size_t inner, std::size_t rows) {
  constexpr std::size_t vectors = columns > 2 ? 2 : 4;
  constexpr std::size_t tile = width * vectors;
  std::size_t r = 0;
  for (; r + tile <= rows; r += tile) {
    subtract_tile<width, vectors, columns>(c.from(r, 0), a.from(r, 0), x, inner);
  }
  if constexpr (tile > group) {
    for (; r < rows; r += group) {
      subtract_tile<width, group / width, columns>(c.from(r, 0), a.from(r, 0), x, inner);
    }
  }
}

// Subtracts from columns j on, `count` at a time while that many remain.
template <std::size_t width, std::size_t count>
GRAINLAW_INLINE void subtract_by(const Matrix& c, const Matrix& a, const Matrix& x,
                                 std::size_t inner, std::size_t rows, std::size_t columns,
                                 std::size_t& j) {
  for (; j + count <= columns; j += count) {
    subtract_columns<width, count>(c.from(0, j), a, x.from(0, j), inner, rows);
  }
}

// Subtracts a x from c, for whole groups of rows.
template <std::size_t width>
GRAINLAW_INLINE void subtract_product(const Matrix& c, const Matrix& a, const Matrix& x,
                                      std::size_t inner, std::size_t rows, std::size_t columns) {
  std::size_t j = 0;
  subtract_by<width, 6>(c, a, x, inner, rows, columns, j);
  subtract_by<width, 4>(c, a, x, inner, rows, columns, j);
  subtract_by<width, 2>(c, a, x, inner, rows, columns, j);
  subtract_by<width, 1>(c, a, x, inner, rows, columns, j);
}

}  // namespace grainlaw::core::dense
