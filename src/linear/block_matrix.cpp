#include "linear/block_matrix.hpp"

#include "base/room.hpp"
#include "linear/quad.hpp"

#include <algorithm>

namespace grainlaw {

using namespace quad;

namespace {

// r = b - A x by blocks; `add` is told the block and its row and column.
template <class Add>
GRAINLAW_INLINE void for_each_block(const BlockMatrix& a, const Add& add) {
  const auto size = static_cast<std::size_t>(a.components) * width;
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
GRAINLAW_INLINE void subtract(const BlockMatrix& a, const double* x, double* r) {
  for_each_block(a, [=](const double* block, std::size_t row, std::size_t column) {
    Lanes sum = load(r + row * width);
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) sum -= load(block + c * width) * x[column * width + c];
    store(r + row * width, sum);
  });
}

template <std::size_t b>
GRAINLAW_INLINE void subtract_of_four(const BlockMatrix& a, const double* x, double* r) {
  for_each_block(a, [=](const double* block, std::size_t row, std::size_t column) {
    const double* from = x + column * b * width;
    double* to = r + row * b * width;
    Lanes sum[b];
#pragma GCC unroll 3
    for (std::size_t k = 0; k < b; ++k) sum[k] = load(to + k * width);
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) {
      const Lanes value = load(from + c * width);
#pragma GCC unroll 3
      for (std::size_t k = 0; k < b; ++k) sum[k] -= block[c * width + k] * value;
    }
#pragma GCC unroll 3
    for (std::size_t k = 0; k < b; ++k) store(to + k * width, sum[k]);
  });
}

GRAINLAW_CLONES void subtract_blocks(const BlockMatrix& a, const double* x, double* r) {
  a.components == 3 ? subtract<3>(a, x, r) : subtract<2>(a, x, r);
}

GRAINLAW_CLONES void subtract_blocks_of_four(const BlockMatrix& a, const double* x, double* r) {
  a.components == 3 ? subtract_of_four<3>(a, x, r) : subtract_of_four<2>(a, x, r);
}

}  // namespace

void BlockMatrix::reset(std::size_t node_count, int component_count, std::span<const Edge> graph) {
  nodes = node_count;
  components = component_count;
  resize_with_room(edges, graph.size());
  std::copy(graph.begin(), graph.end(), edges.begin());
  resize_with_room(blocks, (nodes + 2 * edges.size()) * static_cast<std::size_t>(components));
  set_zero();
}

void BlockMatrix::set_zero() { std::fill(blocks.begin(), blocks.end(), Quad{}); }

void BlockMatrix::subtract_product(std::span<const Quad> x, std::span<Quad> r) const {
  subtract_blocks(*this, x.data()->lane, r.data()->lane);
}

void BlockMatrix::residual(std::span<const Quad> b, std::span<const Quad> x,
                           std::span<Quad> r) const {
  std::copy(b.begin(), b.end(), r.begin());
  subtract_product(x, r);
}

void BlockMatrix::residual_of_four(std::span<const Quad> b, std::span<const Quad> x,
                                   std::span<Quad> r) const {
  std::copy(b.begin(), b.end(), r.begin());
  subtract_blocks_of_four(*this, x.data()->lane, r.data()->lane);
}

}  // namespace grainlaw
