// Sparse matrix of small blocks on the graph of nodes.
#pragma once

#include "linear/columns.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace grainlaw::core {

using Edge = std::pair<std::int32_t, std::int32_t>;  // first < second

// Blocks of components x components, column-major. A vector over the nodes is one BlockColumn per
// node; several vectors are one Together per node and component.
template <std::size_t width>
struct BlockMatrix {
  using Column = BlockColumn<width>;

  BlockSize<width> components{};
  std::size_t nodes = 0;
  std::vector<Edge> edges;  // unique, ordered
  std::vector<Column>
      blocks;  // [nodes] on the diagonal, [edges] (first, second), [edges] (second, first)

  // Indices into `blocks` of an edge's blocks; a block starts with its first column.
  [[nodiscard]] std::size_t upper(std::size_t edge) const { return nodes + edge; }
  [[nodiscard]] std::size_t lower(std::size_t edge) const { return nodes + edges.size() + edge; }
  [[nodiscard]] Column* block(std::size_t index) {
    return blocks.data() + index * static_cast<std::size_t>(components);
  }
  [[nodiscard]] const Column* block(std::size_t index) const {
    return blocks.data() + index * static_cast<std::size_t>(components);
  }
  // Sets the graph and all values to zero.
  void reset(std::size_t node_count, BlockSize<width> size, std::span<const Edge> graph);
  void set_zero();
  void subtract_product(std::span<const Column> x, std::span<Column> r) const;  // r -= A x
  // Computes r = b - A x, for one vector.
  void residual(std::span<const Column> b, std::span<const Column> x, std::span<Column> r) const;
  // Computes r = b - A x, for several vectors.
  void residual_together(std::span<const Together<width>> b, std::span<const Together<width>> x,
                         std::span<Together<width>> r) const;
};

}  // namespace grainlaw::core
