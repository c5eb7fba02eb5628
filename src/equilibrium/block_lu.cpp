#include "equilibrium/block_matrix.hpp"

#include "room.hpp"
#include "simd.hpp"

#include <amd.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace grainlaw {

using simd::store;
using Lanes = simd::Lanes<4>;  // of a quad
constexpr std::size_t width = 4;
GRAINLAW_INLINE Lanes load(const double* from) { return simd::load<4>(from); }
static_assert(sizeof(Quad) == sizeof(Lanes));

struct BlockLU::Factor {
  std::size_t nodes;
  const std::size_t* begin;
  const std::size_t* diagonal;
  const char* paired;
  const std::int32_t* rows;
  const std::int32_t* node;
  const std::size_t* source_begin;
  const Source* sources;
  std::int32_t* where;
  const double* added;  // may be null
  const double* matrix;
  double* values;
};

namespace {

using Factor = BlockLU::Factor;

template <int b>
struct Block {
  Lanes column[b];
};

template <int b>
GRAINLAW_INLINE Block<b> load_block(const double* from) {
  Block<b> block;
#pragma GCC unroll 3
  for (std::size_t c = 0; c < b; ++c) block.column[c] = load(from + c * width);
  return block;
}

template <int b>
GRAINLAW_INLINE void store_block(double* to, const Block<b>& block) {
#pragma GCC unroll 3
  for (std::size_t c = 0; c < b; ++c) store(to + c * width, block.column[c]);
}

// The entries of a block, each in all lanes.
template <int b>
struct Spread {
  Lanes entry[b][b];  // [column][row]
};

template <int b>
GRAINLAW_INLINE Spread<b> spread(const double* block) {
  Spread<b> result;
#pragma GCC unroll 3
  for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 3
    for (std::size_t r = 0; r < b; ++r) result.entry[c][r] = Lanes{} + block[c * width + r];
  }
  return result;
}

// c -= a x
template <int b>
GRAINLAW_INLINE void subtract_product(Block<b>& c, const Block<b>& a, const Spread<b>& x) {
#pragma GCC unroll 3
  for (std::size_t k = 0; k < b; ++k) {
#pragma GCC unroll 3
    for (std::size_t column = 0; column < b; ++column) {
      c.column[column] -= a.column[k] * x.entry[column][k];
    }
  }
}

// In place, by Gauss-Jordan with row pivoting. False when singular.
template <int b>
bool invert_with_pivoting(double* a) {
  constexpr std::size_t s = width;
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
  constexpr std::size_t s = width;
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
  store(a, Lanes{c00, c10, c20, 0} * f);
  store(a + s, Lanes{a02 * a21 - a01 * a22, a00 * a22 - a02 * a20, a01 * a20 - a00 * a21, 0} * f);
  store(a + 2 * s,
        Lanes{a01 * a12 - a02 * a11, a02 * a10 - a00 * a12, a00 * a11 - a01 * a10, 0} * f);
  return true;
}

GRAINLAW_INLINE bool invert(double* a, std::integral_constant<int, 2>) {
  constexpr std::size_t s = width;
  const double a00 = a[0], a10 = a[1], a01 = a[s], a11 = a[s + 1];
  const double determinant = a00 * a11 - a01 * a10;
  const double size = std::abs(a00 * a11) + std::abs(a01 * a10);
  if (!(std::abs(determinant) > safe_determinant * size)) return invert_with_pivoting<2>(a);
  const double f = 1 / determinant;
  store(a, Lanes{a11, -a10, 0, 0} * f);
  store(a + s, Lanes{-a01, a00, 0, 0} * f);
  return true;
}

template <int b>
GRAINLAW_INLINE bool factorise_columns(const Factor& f) {
  constexpr std::size_t size = b * width;
  const std::size_t nodes = f.nodes;
  const std::size_t* const begin = f.begin;
  const std::size_t* const diagonal = f.diagonal;
  const std::int32_t* const rows = f.rows;
  std::int32_t* const where = f.where;
  double* const values = f.values;
  for (std::size_t j = 0; j < nodes; ++j) {
    double* const column = values + begin[j] * size;
    for (std::size_t slot = begin[j]; slot < begin[j + 1]; ++slot) {
      where[rows[slot]] = static_cast<std::int32_t>((slot - begin[j]) * size);
      store_block<b>(values + slot * size, Block<b>{});
    }
    const auto node = static_cast<std::size_t>(f.node[j]);
    double* const pivot = values + diagonal[j] * size;
    store_block<b>(pivot, load_block<b>(f.matrix + node * size));
    if (f.added != nullptr) {
      for (std::size_t k = 0; k < b; ++k) pivot[k * width + k] += f.added[node * width + k];
    }
    for (std::size_t k = f.source_begin[j]; k < f.source_begin[j + 1]; ++k) {
      const auto [slot, block] = f.sources[k];
      store_block<b>(values + static_cast<std::size_t>(slot) * size,
                     load_block<b>(f.matrix + static_cast<std::size_t>(block) * size));
    }

    for (std::size_t slot = begin[j]; slot < diagonal[j]; ++slot) {
      const auto k = static_cast<std::size_t>(rows[slot]);
      const Spread<b> x = spread<b>(values + slot * size);
      const double* a = values + (diagonal[k] + 1) * size;
      const std::int32_t* row = rows + diagonal[k] + 1;
      const std::int32_t* const end = rows + begin[k + 1];
      if (f.paired[k] == 0 || k + 1 == j) {
        for (; row != end; ++row, a += size) {
          double* const to = column + where[*row];
          Block<b> c = load_block<b>(to);
          subtract_product<b>(c, load_block<b>(a), x);
          store_block<b>(to, c);
        }
        continue;
      }
      // The next column has the same rows: both at once.
      Block<b> next = load_block<b>(values + (slot + 1) * size);
      subtract_product<b>(next, load_block<b>(a), x);
      store_block<b>(values + (slot + 1) * size, next);
      const Spread<b> y = spread<b>(values + (slot + 1) * size);
      const double* d = values + (diagonal[k + 1] + 1) * size;
      for (++row, a += size; row != end; ++row, a += size, d += size) {
        double* const to = column + where[*row];
        Block<b> c = load_block<b>(to);
        subtract_product<b>(c, load_block<b>(a), x);
        subtract_product<b>(c, load_block<b>(d), y);
        store_block<b>(to, c);
      }
      ++slot;
    }

    if (!invert(pivot, std::integral_constant<int, b>{})) return false;
    const Spread<b> inverse = spread<b>(pivot);
    for (std::size_t slot = diagonal[j] + 1; slot < begin[j + 1]; ++slot) {
      const Block<b> a = load_block<b>(values + slot * size);
      Block<b> product;
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
        product.column[c] = a.column[0] * inverse.entry[c][0];
#pragma GCC unroll 3
        for (std::size_t k = 1; k < b; ++k) product.column[c] += a.column[k] * inverse.entry[c][k];
      }
      store_block<b>(values + slot * size, product);
    }
  }
  return true;
}

GRAINLAW_CLONES bool factorise_3(const Factor& f) { return factorise_columns<3>(f); }
GRAINLAW_CLONES bool factorise_2(const Factor& f) { return factorise_columns<2>(f); }

// In the elimination's order.
template <int b>
GRAINLAW_INLINE void substitute(const Factor& f, double* y) {
  constexpr std::size_t size = b * width;
  const double* const values = f.values;
  const auto subtract = [&](std::size_t first, std::size_t last, const Lanes& x) {
    Lanes each[b];
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) each[c] = Lanes{} + x[c];
    for (std::size_t slot = first; slot < last; ++slot) {
      double* const to = y + static_cast<std::size_t>(f.rows[slot]) * width;
      const Block<b> block = load_block<b>(values + slot * size);
      Lanes sum = load(to);
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) sum -= block.column[c] * each[c];
      store(to, sum);
    }
  };
  for (std::size_t j = 0; j < f.nodes; ++j) {
    subtract(f.diagonal[j] + 1, f.begin[j + 1], load(y + j * width));
  }
  for (std::size_t j = f.nodes; j-- > 0;) {
    const Block<b> inverse = load_block<b>(values + f.diagonal[j] * size);
    const double* const from = y + j * width;
    Lanes x = inverse.column[0] * from[0];
#pragma GCC unroll 3
    for (std::size_t c = 1; c < b; ++c) x += inverse.column[c] * from[c];
    store(y + j * width, x);
    subtract(f.begin[j], f.diagonal[j], x);
  }
}

GRAINLAW_CLONES void substitute_3(const Factor& f, double* y) { substitute<3>(f, y); }
GRAINLAW_CLONES void substitute_2(const Factor& f, double* y) { substitute<2>(f, y); }

// A vector in every lane.
template <int b>
GRAINLAW_INLINE void substitute_four(const Factor& f, double* y) {
  constexpr std::size_t size = b * width;
  const double* const values = f.values;
  const auto subtract = [&](std::size_t first, std::size_t last, const Block<b>& x) {
    for (std::size_t slot = first; slot < last; ++slot) {
      double* const to = y + static_cast<std::size_t>(f.rows[slot]) * size;
      const double* const block = values + slot * size;
      Block<b> sum = load_block<b>(to);
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 3
        for (std::size_t r = 0; r < b; ++r) sum.column[r] -= block[c * width + r] * x.column[c];
      }
      store_block<b>(to, sum);
    }
  };
  for (std::size_t j = 0; j < f.nodes; ++j) {
    subtract(f.diagonal[j] + 1, f.begin[j + 1], load_block<b>(y + j * size));
  }
  for (std::size_t j = f.nodes; j-- > 0;) {
    const double* const inverse = values + f.diagonal[j] * size;
    const Block<b> from = load_block<b>(y + j * size);
    Block<b> x;
#pragma GCC unroll 3
    for (std::size_t r = 0; r < b; ++r) {
      x.column[r] = inverse[r] * from.column[0];
#pragma GCC unroll 3
      for (std::size_t c = 1; c < b; ++c) x.column[r] += inverse[c * width + r] * from.column[c];
    }
    store_block<b>(y + j * size, x);
    subtract(f.begin[j], f.diagonal[j], x);
  }
}

GRAINLAW_CLONES void substitute_four_3(const Factor& f, double* y) { substitute_four<3>(f, y); }
GRAINLAW_CLONES void substitute_four_2(const Factor& f, double* y) { substitute_four<2>(f, y); }

}  // namespace

void BlockLU::order(std::size_t nodes, std::span<const Edge> edges) {
  const std::size_t entries = 2 * edges.size();
  const std::size_t slack = entries + entries / 2 + nodes + 1;
  resize_with_room(amd_, 9 * nodes + slack);
  std::fill(amd_.begin(), amd_.end(), 0);
  std::int32_t* begin = amd_.data();
  std::int32_t* length = begin + nodes;
  std::int32_t* size = length + nodes;
  std::int32_t* next = size + nodes;
  std::int32_t* last = next + nodes;
  std::int32_t* head = last + nodes;
  std::int32_t* elements = head + nodes;
  std::int32_t* degree = elements + nodes;
  std::int32_t* flags = degree + nodes;
  std::int32_t* neighbours = flags + nodes;
  for (const auto& [p, q] : edges) {
    ++length[p];
    ++length[q];
  }
  std::int32_t free = 0;
  for (std::size_t q = 0; q < nodes; ++q) {
    begin[q] = free;
    free += length[q];
    length[q] = 0;
  }
  for (const auto& [p, q] : edges) {
    neighbours[begin[p] + length[p]++] = q;
    neighbours[begin[q] + length[q]++] = p;
  }
  double control[AMD_CONTROL];
  double info[AMD_INFO];
  amd_defaults(control);
  amd_2(static_cast<std::int32_t>(nodes), begin, neighbours, length,
        static_cast<std::int32_t>(slack), free, size, next, last, head, elements, degree, flags,
        control, info);
  position_.assign(next, next + nodes);
  resize_with_room(node_, nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    node_[static_cast<std::size_t>(position_[q])] = static_cast<std::int32_t>(q);
  }
}

// For every row of the factor the columns left of the diagonal that it reaches (Davis 2006, chapter
// 4: paths in the elimination tree), sorted; and how many rows every column has below the diagonal.
void BlockLU::find_reach() {
  resize_with_room(adjacency_begin_, nodes_ + 1);
  std::fill(adjacency_begin_.begin(), adjacency_begin_.end(), 0);
  const auto places = [&](const Edge& edge) {
    return std::minmax(position_[static_cast<std::size_t>(edge.first)],
                       position_[static_cast<std::size_t>(edge.second)]);
  };
  for (const auto& edge : edges_) {
    ++adjacency_begin_[static_cast<std::size_t>(std::get<1>(places(edge))) + 1];
  }
  for (std::size_t j = 0; j < nodes_; ++j) adjacency_begin_[j + 1] += adjacency_begin_[j];
  resize_with_room(adjacency_, edges_.size());
  resize_with_room(below_, nodes_);
  std::copy_n(adjacency_begin_.begin(), nodes_, below_.begin());
  for (const auto& edge : edges_) {
    const auto [low, high] = places(edge);
    adjacency_[below_[static_cast<std::size_t>(high)]++] = low;
  }

  resize_with_room(parent_, nodes_);
  resize_with_room(ancestor_, nodes_);
  resize_with_room(where_, nodes_);
  resize_with_room(reach_begin_, nodes_ + 1);
  std::fill(below_.begin(), below_.end(), 0);
  reach_.clear();
  for (std::size_t j = 0; j < nodes_; ++j) {
    const auto row = static_cast<std::int32_t>(j);
    parent_[j] = ancestor_[j] = -1;
    where_[j] = row;  // visited by this row
    reach_begin_[j] = reach_.size();
    for (std::size_t k = adjacency_begin_[j]; k < adjacency_begin_[j + 1]; ++k) {
      for (std::int32_t r = adjacency_[k]; r != -1 && r < row;) {
        const auto at = static_cast<std::size_t>(r);
        const std::int32_t next = ancestor_[at];
        ancestor_[at] = row;
        if (next == -1) parent_[at] = row;
        r = next;
      }
    }
    for (std::size_t k = adjacency_begin_[j]; k < adjacency_begin_[j + 1]; ++k) {
      for (std::int32_t r = adjacency_[k]; where_[static_cast<std::size_t>(r)] != row;
           r = parent_[static_cast<std::size_t>(r)]) {
        where_[static_cast<std::size_t>(r)] = row;
        ++below_[static_cast<std::size_t>(r)];
        reach_.push_back(r);
      }
    }
    std::sort(reach_.begin() + static_cast<std::ptrdiff_t>(reach_begin_[j]), reach_.end());
  }
  reach_begin_[nodes_] = reach_.size();
  keep_room(reach_);
}

// Column j: its reach above the diagonal, and below it the rows whose reach holds j.
void BlockLU::find_columns() {
  resize_with_room(begin_, nodes_ + 1);
  resize_with_room(diagonal_, nodes_);
  resize_with_room(paired_, nodes_);
  resize_with_room(rows_, nodes_ + 2 * reach_.size());
  std::size_t slot = 0;
  for (std::size_t j = 0; j < nodes_; ++j) {
    paired_[j] = j + 1 < nodes_ && parent_[j] == static_cast<std::int32_t>(j + 1) &&
                 below_[j] == below_[j + 1] + 1;
    begin_[j] = slot;
    for (std::size_t k = reach_begin_[j]; k < reach_begin_[j + 1]; ++k) rows_[slot++] = reach_[k];
    diagonal_[j] = slot;
    rows_[slot++] = static_cast<std::int32_t>(j);
    slot += below_[j];
  }
  begin_[nodes_] = slot;
  for (std::size_t j = 0; j < nodes_; ++j) below_[j] = diagonal_[j] + 1;  // where the next row goes
  for (std::size_t row = 0; row < nodes_; ++row) {
    for (std::size_t k = reach_begin_[row]; k < reach_begin_[row + 1]; ++k) {
      rows_[below_[static_cast<std::size_t>(reach_[k])]++] = static_cast<std::int32_t>(row);
    }
  }
}

// Where the blocks of the matrix go, column by column.
void BlockLU::find_sources() {
  const auto slot_of = [&](std::int32_t row, std::int32_t column) {
    const auto j = static_cast<std::size_t>(column);
    const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[j]);
    const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[j + 1]);
    return static_cast<std::int32_t>(std::lower_bound(first, last, row) - rows_.begin());
  };
  const auto places = [&](const Edge& edge) {
    return std::pair{position_[static_cast<std::size_t>(edge.first)],
                     position_[static_cast<std::size_t>(edge.second)]};
  };
  resize_with_room(source_begin_, nodes_ + 1);
  resize_with_room(sources_, 2 * edges_.size());
  std::fill(source_begin_.begin(), source_begin_.end(), 0);
  for (const auto& edge : edges_) {
    const auto [p, q] = places(edge);
    ++source_begin_[static_cast<std::size_t>(p) + 1];
    ++source_begin_[static_cast<std::size_t>(q) + 1];
  }
  for (std::size_t j = 0; j < nodes_; ++j) source_begin_[j + 1] += source_begin_[j];
  std::copy_n(source_begin_.begin(), nodes_, below_.begin());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [p, q] = places(edges_[e]);
    const auto upper = static_cast<std::int32_t>(nodes_ + e);
    const auto lower = static_cast<std::int32_t>(nodes_ + edges_.size() + e);
    sources_[below_[static_cast<std::size_t>(q)]++] = {slot_of(p, q), upper};
    sources_[below_[static_cast<std::size_t>(p)]++] = {slot_of(q, p), lower};
  }
}

void BlockLU::analyse(const BlockMatrix& matrix) {
  if (nodes_ == matrix.nodes && components_ == matrix.components && edges_ == matrix.edges &&
      !begin_.empty()) {
    return;
  }
  nodes_ = matrix.nodes;
  components_ = matrix.components;
  resize_with_room(edges_, matrix.edges.size());
  std::copy(matrix.edges.begin(), matrix.edges.end(), edges_.begin());
  order(nodes_, edges_);
  find_reach();
  find_columns();
  find_sources();
}

BlockLU::Factor BlockLU::factor(std::span<const Quad> added, const BlockMatrix* matrix) {
  return {nodes_,
          begin_.data(),
          diagonal_.data(),
          paired_.data(),
          rows_.data(),
          node_.data(),
          source_begin_.data(),
          sources_.data(),
          where_.data(),
          added.empty() ? nullptr : added.data()->lane,
          matrix == nullptr ? nullptr : matrix->blocks.data()->lane,
          values_.data()->lane};
}

bool BlockLU::factorise(const BlockMatrix& matrix, std::span<const Quad> added) {
  resize_with_room(values_, rows_.size() * static_cast<std::size_t>(components_));
  const Factor f = factor(added, &matrix);
  return components_ == 3 ? factorise_3(f) : factorise_2(f);
}

void BlockLU::solve(std::span<Quad> x) {
  resize_with_room(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) work_[j] = x[static_cast<std::size_t>(node_[j])];
  const Factor f = factor();
  components_ == 3 ? substitute_3(f, work_.data()->lane) : substitute_2(f, work_.data()->lane);
  for (std::size_t j = 0; j < nodes_; ++j) x[static_cast<std::size_t>(node_[j])] = work_[j];
}

void BlockLU::solve_four(std::span<Quad> x) {
  const auto b = static_cast<std::size_t>(components_);
  resize_with_room(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&x[static_cast<std::size_t>(node_[j]) * b], b, &work_[j * b]);
  }
  const Factor f = factor();
  double* y = work_.data()->lane;
  components_ == 3 ? substitute_four_3(f, y) : substitute_four_2(f, y);
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&work_[j * b], b, &x[static_cast<std::size_t>(node_[j]) * b]);
  }
}

}  // namespace grainlaw
