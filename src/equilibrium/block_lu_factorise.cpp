// The numeric factorisation, front by front.
#include "equilibrium/block_lu_view.hpp"
#include "equilibrium/dense_panels.hpp"
#include "equilibrium/quad.hpp"

#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace grainlaw {

using namespace dense;

namespace {

using View = BlockLU::View;
using Front = BlockLU::Front;
using Run = BlockLU::Run;

constexpr std::size_t pivot_stride = 4;  // of a pivot block, from column to column
using Quad4 = simd::Lanes<4>;
GRAINLAW_INLINE void store_quad(double* to, const Quad4& value) { simd::store(to, value); }

// In place, by Gauss-Jordan with row pivoting. False when singular.
template <int b>
bool invert_with_pivoting(double* a) {
  constexpr std::size_t s = pivot_stride;
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
  constexpr std::size_t s = pivot_stride;
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
  store_quad(a, Quad4{c00, c10, c20, 0} * f);
  store_quad(a + s,
             Quad4{a02 * a21 - a01 * a22, a00 * a22 - a02 * a20, a01 * a20 - a00 * a21, 0} * f);
  store_quad(a + 2 * s,
             Quad4{a01 * a12 - a02 * a11, a02 * a10 - a00 * a12, a00 * a11 - a01 * a10, 0} * f);
  return true;
}

GRAINLAW_INLINE bool invert(double* a, std::integral_constant<int, 2>) {
  constexpr std::size_t s = pivot_stride;
  const double a00 = a[0], a10 = a[1], a01 = a[s], a11 = a[s + 1];
  const double determinant = a00 * a11 - a01 * a10;
  const double size = std::abs(a00 * a11) + std::abs(a01 * a10);
  if (!(std::abs(determinant) > safe_determinant * size)) return invert_with_pivoting<2>(a);
  const double f = 1 / determinant;
  store_quad(a, Quad4{a11, -a10, 0, 0} * f);
  store_quad(a + s, Quad4{-a01, a00, 0, 0} * f);
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
    alignas(32) double pivot[b * pivot_stride] = {};
    for (std::size_t c = 0; c < b; ++c) {
      for (std::size_t r = 0; r < b; ++r) pivot[c * pivot_stride + r] = a.column(p + c)[p + r];
    }
    if (!invert(pivot, std::integral_constant<int, b>{})) return false;
    for (std::size_t r = 0; r < rows; r += width) {
      V product[b];
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
        product[c] = load<width>(a.column(p) + r) * pivot[c * pivot_stride];
#pragma GCC unroll 3
        for (std::size_t k = 1; k < b; ++k) {
          product[c] += load<width>(a.column(p + k) + r) * pivot[c * pivot_stride + k];
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
      for (std::size_t r = 0; r < b; ++r) a.column(p + c)[p + r] = pivot[c * pivot_stride + r];
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

// The matrix and what is added to its diagonal, which may be null.
struct Values {
  const double* blocks;
  const double* added;
};

template <std::size_t b>
GRAINLAW_INLINE void open_front(const View& f, const Front& front) {
  const Shape shape(front.pivots, front.others, b);
  std::fill_n(f.values + front.values, shape.panel_size(), 0.0);
  std::fill_n(f.values + front.left, shape.left_size(), 0.0);
}

template <std::size_t b>
GRAINLAW_INLINE void add_block(double* to, std::size_t stride, const double* from) {
#pragma GCC unroll 3
  for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 3
    for (std::size_t r = 0; r < b; ++r) to[c * stride + r] += from[c * quad::width + r];
  }
}

template <std::size_t b>
GRAINLAW_INLINE void add_matrix(const View& f, const Front& front, const Shape& shape,
                                const Values& matrix) {
  constexpr std::size_t size = b * quad::width;
  for (std::size_t k = 0; k < front.pivots; ++k) {
    const auto node = static_cast<std::size_t>(f.node[front.first + k]);
    double* const to = f.values + front.values + shape.place(k, k);
    add_block<b>(to, shape.pivot_rows, matrix.blocks + node * size);
    if (matrix.added == nullptr) continue;
    for (std::size_t c = 0; c < b; ++c) {
      to[c * (shape.pivot_rows + 1)] += matrix.added[node * quad::width + c];
    }
  }
  for (std::size_t k = front.first_source; k < front.last_source; ++k) {
    const auto& source = f.sources[k];
    __builtin_prefetch(matrix.blocks + f.sources[k + BlockLU::ahead].block * size);
    add_block<b>(f.values + source.to, source.stride, matrix.blocks + source.block * size);
  }
}

// to += from; lanes beyond the last row get zeros.
template <std::size_t width>
GRAINLAW_INLINE void add(const Matrix& to, const Matrix& from, std::size_t rows,
                         std::size_t columns) {
  using V = simd::Lanes<width>;
  std::size_t r = 0;
  for (; r + width <= rows; r += width) {
    for (std::size_t c = 0; c < columns; ++c) {
      double* const at = to.column(c) + r;
      store(at, load<width>(at) + load<width>(from.column(c) + r));
    }
  }
  if (r == rows) return;
  const Bits<width> there = first_lanes<width>(rows - r);
  for (std::size_t c = 0; c < columns; ++c) {
    double* const at = to.column(c) + r;
    store(at, load<width>(at) + (V)((Bits<width>)load<width>(from.column(c) + r) & there));
  }
}

// The nodes of a front from `begin` to `end`, in runs of which each is one in the parent too.
template <std::size_t b>
GRAINLAW_INLINE std::size_t find_runs(const std::int32_t* within, std::size_t begin,
                                      std::size_t end, Run* runs) {
  std::size_t count = 0;
  for (std::size_t k = begin; k < end; ++count) {
    const std::size_t start = k;
    const std::int32_t ahead = within[k] - static_cast<std::int32_t>(k);
    while (++k < end && within[k] - static_cast<std::int32_t>(k) == ahead) {
    }
    runs[count] = {b * start, b * static_cast<std::size_t>(within[start]), b * (k - start)};
  }
  return count;
}

// What a front leaves, to the panels of its parent.
template <std::size_t width, std::size_t b>
GRAINLAW_INLINE void add_to_parent(const View& f, const Front& front, const Shape& shape) {
  const Front& parent = f.fronts[static_cast<std::size_t>(front.parent)];
  const Shape to(parent.pivots, parent.others, b);
  Run* const pivots = f.runs;
  const std::size_t pivot_runs = find_runs<b>(f.within + front.rows, 0, front.passed, pivots);
  Run* const others = f.runs + pivot_runs;
  const std::size_t other_runs =
      find_runs<b>(f.within + front.rows, front.passed, front.others, others);
  const Matrix from{f.values + front.left, shape.other_rows};
  const auto add_all = [&](const Matrix& panel, const Run* rows, std::size_t row_runs,
                           const Run* columns, std::size_t column_runs) GRAINLAW_INLINED {
    for (std::size_t j = 0; j < column_runs; ++j) {
      for (std::size_t i = 0; i < row_runs; ++i) {
        add<width>(panel.from(rows[i].to, columns[j].to), from.from(rows[i].from, columns[j].from),
                   rows[i].count, columns[j].count);
      }
    }
  };
  double* const values = f.values + parent.values;
  add_all({values, to.pivot_rows}, pivots, pivot_runs, pivots, pivot_runs + other_runs);
  add_all({values + to.other_panel() - to.eliminated, to.other_rows}, others, other_runs, pivots,
          pivot_runs);
  add_all({f.values + parent.left - to.eliminated * (1 + to.other_rows), to.other_rows}, others,
          other_runs, others, other_runs);
}

template <std::size_t width, std::size_t b>
GRAINLAW_INLINE bool eliminate(const View& f, const Front& front, const Shape& shape) {
  alignas(64) double memory[block * block];
  double* const values = f.values + front.values;
  const Matrix pivots{values, shape.pivot_rows};
  const Matrix others{values + shape.other_panel(), shape.other_rows};
  const std::size_t all = shape.eliminated + shape.others;
  for (std::size_t p = 0; p < shape.eliminated; p += block) {
    const std::size_t count = std::min(block, shape.eliminated - p);
    const std::size_t next = p + count;
    const std::size_t rows = whole_groups(count);
    const Matrix diagonal = pivots.from(p, p);
    const Matrix lower{memory, rows};
    if (!factorise_block<width, b>(diagonal, count / b, rows, lower)) return false;
    solve_lower<width, b>(pivots.from(p, next), lower, count, rows, all - next);
    solve_upper<width, b>(others.from(0, p), diagonal, count, shape.other_rows);
    if (next == shape.eliminated) break;
    const Matrix below = pivots.from(next, p);
    solve_upper<width, b>(below, diagonal, count, shape.pivot_rows - next);
    subtract_product<width>(pivots.from(next, next), below, pivots.from(p, next), count,
                            shape.pivot_rows - next, all - next);
    subtract_product<width>(others.from(0, next), others.from(0, p), pivots.from(p, next), count,
                            shape.other_rows, shape.eliminated - next);
  }
  const Matrix left{f.values + front.left, shape.other_rows};
  subtract_product<width>(left, others, pivots.from(0, shape.eliminated), shape.eliminated,
                          shape.other_rows, shape.others);
  return true;
}

template <std::size_t width, std::size_t b>
GRAINLAW_INLINE bool factorise_fronts(const View& f, const Values& matrix) {
  for (const Front& front : f.fronts) {
    const Shape shape(front.pivots, front.others, b);
    if (front.is_leaf) open_front<b>(f, front);
    add_matrix<b>(f, front, shape, matrix);
    if (!eliminate<width, b>(f, front, shape)) return false;
    if (front.parent == -1) continue;
    if (front.opens) open_front<b>(f, f.fronts[static_cast<std::size_t>(front.parent)]);
    add_to_parent<width, b>(f, front, shape);
  }
  return true;
}

GRAINLAW_BY_LANES(bool, factorise_3, factorise_fronts, (const View& f, const Values& m), (f, m), 3)
GRAINLAW_BY_LANES(bool, factorise_2, factorise_fronts, (const View& f, const Values& m), (f, m), 2)

}  // namespace

BlockLU::View BlockLU::view() {
  return {fronts_,         rows_.data(),   within_.data(), node_.data(),
          sources_.data(), values_.data(), runs_.data()};
}

bool BlockLU::factorise(const BlockMatrix& matrix, std::span<const Quad> added) {
  const Values values{matrix.blocks.data()->lane, added.empty() ? nullptr : added.data()->lane};
  return components_ == 3 ? factorise_3(view(), values) : factorise_2(view(), values);
}

}  // namespace grainlaw
