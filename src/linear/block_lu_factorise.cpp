// Numeric factorisation, front by front.
#include "linear/block_lu.hpp"
#include "linear/dense_pivots.hpp"

namespace grainlaw::core {

using namespace dense;

namespace {

using View = Elimination::View;
using Front = Elimination::Front;
using Run = Elimination::Run;

// Matrix, and what is added to its diagonal; null: nothing.
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
#pragma GCC unroll 6
  for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 6
    for (std::size_t r = 0; r < b; ++r) to[c * stride + r] += from[c * rows_of(b) + r];
  }
}

template <std::size_t b>
GRAINLAW_INLINE void add_matrix(const View& f, const Front& front, const Shape& shape,
                                const Values& matrix) {
  constexpr std::size_t size = b * rows_of(b);
  for (std::size_t k = 0; k < front.pivots; ++k) {
    const auto node = static_cast<std::size_t>(f.node[front.first + k]);
    double* const to = f.values + front.values + shape.offset(k, k);
    add_block<b>(to, shape.pivot_rows, matrix.blocks + node * size);
    if (matrix.added == nullptr) continue;
    for (std::size_t c = 0; c < b; ++c) {
      to[c * (shape.pivot_rows + 1)] += matrix.added[node * rows_of(b) + c];
    }
  }
  for (std::size_t k = front.first_source; k < front.last_source; ++k) {
    const auto& source = f.sources[k];
    __builtin_prefetch(matrix.blocks + f.sources[k + Elimination::ahead].block * size);
    add_block<b>(f.values + source.to, source.stride, matrix.blocks + source.block * size);
  }
}

// Adds `from` to `to`; lanes beyond the last row get zeros.
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

// Finds runs of nodes in [begin, end) that are consecutive in the parent too, and returns their
// number.
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

// Adds the Schur complement of a front to the panels of its parent.
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
                           std::size_t first_row, const Run* columns, std::size_t column_runs,
                           std::size_t first_column) GRAINLAW_INLINED {
    for (std::size_t j = 0; j < column_runs; ++j) {
      for (std::size_t i = 0; i < row_runs; ++i) {
        add<width>(panel.from(rows[i].to - first_row, columns[j].to - first_column),
                   from.from(rows[i].from, columns[j].from), rows[i].count, columns[j].count);
      }
    }
  };
  const Matrix pivot_panel{f.values + parent.values, to.pivot_rows};
  const Matrix other_panel{pivot_panel.at + to.other_panel(), to.other_rows};
  const Matrix left{f.values + parent.left, to.other_rows};
  add_all(pivot_panel, pivots, pivot_runs, 0, pivots, pivot_runs + other_runs, 0);
  add_all(other_panel, others, other_runs, to.eliminated, pivots, pivot_runs, 0);
  add_all(left, others, other_runs, to.eliminated, others, other_runs, to.eliminated);
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
    Pivot* const kept = f.pivots + front.first + p / b;
    if (!factorise_diagonal<width, b>(diagonal, count / b, rows, kept, lower)) return false;
    solve_lower<width, b>(pivots.from(p, next), lower, count, rows, all - next);
    solve_upper<width, b>(others.from(0, p), diagonal, kept, count, shape.other_rows);
    if (next == shape.eliminated) break;
    const Matrix below = pivots.from(next, p);
    solve_upper<width, b>(below, diagonal, kept, count, shape.pivot_rows - next);
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

GRAINLAW_BY_LANES(bool, factorise_2, factorise_fronts, (const View& f, const Values& m), (f, m), 2)
GRAINLAW_BY_LANES(bool, factorise_3, factorise_fronts, (const View& f, const Values& m), (f, m), 3)
GRAINLAW_BY_LANES(bool, factorise_6, factorise_fronts, (const View& f, const Values& m), (f, m), 6)

}  // namespace

template <std::size_t width>
bool BlockLU<width>::factorise(const BlockMatrix<width>& matrix, std::span<const Column> added) {
  const Values values{matrix.blocks.data()->lane, added.empty() ? nullptr : added.data()->lane};
  const View view = elimination_.view();
  if constexpr (width == 8) return factorise_6(view, values);
  return components_ == 3 ? factorise_3(view, values) : factorise_2(view, values);
}

template bool BlockLU<4>::factorise(const BlockMatrix<4>&, std::span<const Column>);
template bool BlockLU<8>::factorise(const BlockMatrix<8>&, std::span<const Column>);

}  // namespace grainlaw::core
