#include "equilibrium/block_matrix.hpp"

#include "room.hpp"

#include <amd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GRAINLAW_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define GRAINLAW_CLONES
#endif
#define GRAINLAW_INLINE inline __attribute__((always_inline))

namespace grainlaw {

namespace {

// C -= A X, padded columns as the compiler's vector type: loops over three rows are not vectorised.
template <int b, int s>
GRAINLAW_INLINE void subtract_product(double* c, const double* a, const double* x) {
  typedef double Column __attribute__((vector_size(s * sizeof(double))));
  Column a_column[b];
  Column sum[b];
#pragma GCC unroll 3
  for (int k = 0; k < b; ++k) std::memcpy(&a_column[k], a + k * s, sizeof(Column));
#pragma GCC unroll 3
  for (int k = 0; k < b; ++k) std::memcpy(&sum[k], c + k * s, sizeof(Column));
#pragma GCC unroll 3
  for (int k = 0; k < b; ++k) {
#pragma GCC unroll 3
    for (int column = 0; column < b; ++column) sum[column] -= a_column[k] * x[column * s + k];
  }
#pragma GCC unroll 3
  for (int k = 0; k < b; ++k) std::memcpy(c + k * s, &sum[k], sizeof(Column));
}

template <int b, int s>
GRAINLAW_INLINE void multiply_right(double* a, const double* x) {
  double result[b * s] = {};
  for (int column = 0; column < b; ++column) {
    for (int k = 0; k < b; ++k) {
      for (int row = 0; row < s; ++row) {
        result[column * s + row] += a[k * s + row] * x[column * s + k];
      }
    }
  }
  std::copy_n(result, b * s, a);
}

// In place, by Gauss-Jordan with row pivoting. False when singular.
template <int b, int s>
GRAINLAW_INLINE bool invert(double* a) {
  double work[b][2 * b];
  for (int r = 0; r < b; ++r) {
    for (int c = 0; c < b; ++c) {
      work[r][c] = a[c * s + r];
      work[r][b + c] = r == c ? 1 : 0;
    }
  }
  for (int k = 0; k < b; ++k) {
    int pivot = k;
    for (int r = k + 1; r < b; ++r) {
      if (std::abs(work[r][k]) > std::abs(work[pivot][k])) pivot = r;
    }
    const double value = work[pivot][k];
    if (!(std::abs(value) > 0) || !std::isfinite(value)) return false;
    for (int c = 0; c < 2 * b; ++c) std::swap(work[k][c], work[pivot][c]);
    for (int c = 0; c < 2 * b; ++c) work[k][c] /= value;
    for (int r = 0; r < b; ++r) {
      if (r == k) continue;
      const double factor = work[r][k];
      for (int c = 0; c < 2 * b; ++c) work[r][c] -= factor * work[k][c];
    }
  }
  for (int r = 0; r < b; ++r) {
    for (int c = 0; c < b; ++c) a[c * s + r] = work[r][b + c];
  }
  return true;
}

struct Factor {
  std::size_t nodes;
  const std::size_t* begin;
  const std::size_t* diagonal;
  const std::int32_t* rows;
  std::int32_t* where;
  double* values;
};

template <int b, int s>
GRAINLAW_INLINE bool factorise_columns(const Factor& f) {
  constexpr std::size_t size = b * s;
  for (std::size_t j = 0; j < f.nodes; ++j) {
    for (std::size_t slot = f.begin[j]; slot < f.begin[j + 1]; ++slot) {
      f.where[f.rows[slot]] = static_cast<std::int32_t>(slot - f.begin[j]);
    }
    double* column = f.values + f.begin[j] * size;
    for (std::size_t slot = f.begin[j]; slot < f.diagonal[j]; ++slot) {
      const auto k = static_cast<std::size_t>(f.rows[slot]);
      double x[size];
      std::copy_n(f.values + slot * size, size, x);
      for (std::size_t below = f.diagonal[k] + 1; below < f.begin[k + 1]; ++below) {
        subtract_product<b, s>(column + static_cast<std::size_t>(f.where[f.rows[below]]) * size,
                               f.values + below * size, x);
      }
    }
    double* pivot = f.values + f.diagonal[j] * size;
    if (!invert<b, s>(pivot)) return false;
    for (std::size_t slot = f.diagonal[j] + 1; slot < f.begin[j + 1]; ++slot) {
      multiply_right<b, s>(f.values + slot * size, pivot);
    }
  }
  return true;
}

GRAINLAW_CLONES bool factorise_3(const Factor& f) { return factorise_columns<3, 4>(f); }
GRAINLAW_CLONES bool factorise_2(const Factor& f) { return factorise_columns<2, 2>(f); }

template <int b, int s>
void substitute(const Factor& f, double* y) {
  constexpr std::size_t size = b * s;
  const auto subtract = [&](std::size_t slot, const double* x) {
    double* target = y + static_cast<std::size_t>(f.rows[slot]) * b;
    const double* block = f.values + slot * size;
    for (int c = 0; c < b; ++c) {
      for (int r = 0; r < b; ++r) target[r] -= block[c * s + r] * x[c];
    }
  };
  for (std::size_t j = 0; j < f.nodes; ++j) {
    for (std::size_t k = f.diagonal[j] + 1; k < f.begin[j + 1]; ++k) subtract(k, y + j * b);
  }
  for (std::size_t j = f.nodes; j-- > 0;) {
    const double* inverse = f.values + f.diagonal[j] * size;
    double x[b] = {};
    for (int c = 0; c < b; ++c) {
      for (int r = 0; r < b; ++r) x[r] += inverse[c * s + r] * y[j * b + c];
    }
    std::copy_n(x, b, y + j * b);
    for (std::size_t k = f.begin[j]; k < f.diagonal[j]; ++k) subtract(k, x);
  }
}

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
  // Column j: its reach above the diagonal, and below it the rows whose reach holds j.
  resize_with_room(begin_, nodes_ + 1);
  resize_with_room(diagonal_, nodes_);
  resize_with_room(rows_, nodes_ + 2 * reach_.size());
  std::size_t slot = 0;
  for (std::size_t j = 0; j < nodes_; ++j) {
    begin_[j] = slot;
    for (std::size_t k = reach_begin_[j]; k < reach_begin_[j + 1]; ++k) rows_[slot++] = reach_[k];
    diagonal_[j] = slot;
    rows_[slot++] = static_cast<std::int32_t>(j);
    slot += below_[j];
    below_[j] = diagonal_[j] + 1;  // from here on where the next row goes
  }
  begin_[nodes_] = slot;
  for (std::size_t row = 0; row < nodes_; ++row) {
    for (std::size_t k = reach_begin_[row]; k < reach_begin_[row + 1]; ++k) {
      rows_[below_[static_cast<std::size_t>(reach_[k])]++] = static_cast<std::int32_t>(row);
    }
  }

  const auto slot_of = [&](std::int32_t row, std::int32_t column) {
    const auto first =
        rows_.begin() + static_cast<std::ptrdiff_t>(begin_[static_cast<std::size_t>(column)]);
    const auto last =
        rows_.begin() + static_cast<std::ptrdiff_t>(begin_[static_cast<std::size_t>(column) + 1]);
    return static_cast<std::size_t>(std::lower_bound(first, last, row) - rows_.begin());
  };
  resize_with_room(upper_slot_, edges_.size());
  resize_with_room(lower_slot_, edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto p = position_[static_cast<std::size_t>(edges_[e].first)];
    const auto q = position_[static_cast<std::size_t>(edges_[e].second)];
    upper_slot_[e] = slot_of(p, q);
    lower_slot_[e] = slot_of(q, p);
  }
  resize_with_room(work_, nodes_ * static_cast<std::size_t>(components_));
}

bool BlockLU::factorise(const BlockMatrix& matrix) {
  const std::size_t size = matrix.block_size();
  resize_with_room(values_, rows_.size() * size);
  std::fill(values_.begin(), values_.end(), 0.0);
  for (std::size_t q = 0; q < nodes_; ++q) {
    const auto slot = diagonal_[static_cast<std::size_t>(position_[q])];
    std::copy_n(matrix.diagonal.data() + q * size, size, values_.data() + slot * size);
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    std::copy_n(matrix.upper.data() + e * size, size, values_.data() + upper_slot_[e] * size);
    std::copy_n(matrix.lower.data() + e * size, size, values_.data() + lower_slot_[e] * size);
  }
  const Factor f{nodes_,       begin_.data(), diagonal_.data(),
                 rows_.data(), where_.data(), values_.data()};
  return components_ == 3 ? factorise_3(f) : factorise_2(f);
}

void BlockLU::solve(std::span<const double> b, std::span<double> x) {
  const auto components = static_cast<std::size_t>(components_);
  for (std::size_t k = 0; k < components; ++k) {
    for (std::size_t q = 0; q < nodes_; ++q) {
      work_[static_cast<std::size_t>(position_[q]) * components + k] = b[k * nodes_ + q];
    }
  }
  const Factor f{nodes_,       begin_.data(), diagonal_.data(),
                 rows_.data(), where_.data(), values_.data()};
  components_ == 3 ? substitute<3, 4>(f, work_.data()) : substitute<2, 2>(f, work_.data());
  for (std::size_t k = 0; k < components; ++k) {
    for (std::size_t q = 0; q < nodes_; ++q) {
      x[k * nodes_ + q] = work_[static_cast<std::size_t>(position_[q]) * components + k];
    }
  }
}

}  // namespace grainlaw
