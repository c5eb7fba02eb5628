// The numeric factorisation, column by column.
#include "equilibrium/block_lu_loops.hpp"

#include "room.hpp"

#include <cmath>
#include <type_traits>
#include <utility>

namespace grainlaw {

using namespace block_lu;

namespace {

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

}  // namespace

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

}  // namespace grainlaw
