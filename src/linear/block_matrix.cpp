#include "linear/block_matrix.hpp"

#include "base/capacity.hpp"

#include <algorithm>

namespace grainlaw::core {

using namespace simd;

namespace {

// Calls add(block, row, column) for each block of b columns.
template <std::size_t b, class Add>
GRAINLAW_INLINE void for_each_block(const BlockMatrix<rows_of(b)>& a, const Add& add) {
  constexpr std::size_t size = b * rows_of(b);
  const double* block = a.blocks.data()->lane;
  for (std::size_t q = 0; q < a.nodes; ++q, block += size) add(block, q, q);
  for (const auto& [p, q] : a.edges) {
    add(block, static_cast<std::size_t>(p), static_cast<std::size_t>(q));
    block += size;
  }
  for (const auto& [p, q] : a.edges) {
    add(block, static_cast<std::size_t>(q), static_cast<std::size_t>(p));
    block += size;
  }
}

template <std::size_t b>
GRAINLAW_INLINE void subtract(const BlockMatrix<rows_of(b)>& a, const double* x, double* r) {
  constexpr std::size_t width = rows_of(b);
  for_each_block<b>(a, [=](const double* block, std::size_t row, std::size_t column) {
    auto sum = load<width>(r + row * width);
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) {
      sum -= load<width>(block + c * width) * x[column * width + c];
    }
    store(r + row * width, sum);
  });
}

template <std::size_t b>
GRAINLAW_INLINE void subtract_together(const BlockMatrix<rows_of(b)>& a, const double* x,
                                       double* r) {
  constexpr std::size_t width = rows_of(b);
  for_each_block<b>(a, [=](const double* block, std::size_t row, std::size_t column) {
    const double* from = x + column * b * width;
    double* to = r + row * b * width;
    Lanes<width> sum[b];
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) sum[k] = load<width>(to + k * width);
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) {
      const auto value = load<width>(from + c * width);
#pragma GCC unroll 6
      for (std::size_t k = 0; k < b; ++k) sum[k] -= block[c * width + k] * value;
    }
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) store(to + k * width, sum[k]);
  });
}

GRAINLAW_CLONES void subtract_blocks(const BlockMatrix<4>& a, const double* x, double* r) {
  a.components == 3 ? subtract<3>(a, x, r) : subtract<2>(a, x, r);
}
GRAINLAW_CLONES void subtract_blocks(const BlockMatrix<8>& a, const double* x, double* r) {
  subtract<6>(a, x, r);
}

GRAINLAW_CLONES void subtract_blocks_together(const BlockMatrix<4>& a, const double* x, double* r) {
  a.components == 3 ? subtract_together<3>(a, x, r) : subtract_together<2>(a, x, r);
}
GRAINLAW_CLONES void subtract_blocks_together(const BlockMatrix<8>& a, const double* x, double* r) {
  subtract_together<6>(a, x, r);
}

}  // namespace

template <std::size_t width>
void BlockMatrix<width>::reset(std::size_t node_count, BlockSize<width> size,
                               std::span<const Edge> graph) {
  nodes = node_count;
  components = size;
  resize_with_capacity(edges, graph.size());
  std::copy(graph.begin(), graph.end(), edges.begin());
  resize_with_capacity(blocks, (nodes + 2 * edges.size()) * static_cast<std::size_t>(components));
  set_zero();
}

template <std::size_t width>
void BlockMatrix<width>::set_zero() {
  std::fill(blocks.begin(), blocks.end(), Column{});
}

template <std::size_t width>
void BlockMatrix<width>::subtract_product(std::span<const Column> x, std::span<Column> r) const {
  subtract_blocks(*this, x.data()->lane, r.data()->lane);
}

template <std::size_t width>
void BlockMatrix<width>::residual(std::span<const Column> b, std::span<const Column> x,
                                  std::span<Column> r) const {
  std::copy(b.begin(), b.end(), r.begin());
  subtract_product(x, r);
}

template <std::size_t width>
void BlockMatrix<width>::residual_together(std::span<const Together<width>> b,
                                           std::span<const Together<width>> x,
                                           std::span<Together<width>> r) const {
  std::copy(b.begin(), b.end(), r.begin());
  subtract_blocks_together(*this, x.data()->lane, r.data()->lane);
}

template struct BlockMatrix<4>;
template struct BlockMatrix<8>;

}  // namespace grainlaw::core
