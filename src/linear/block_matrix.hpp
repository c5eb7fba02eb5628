// Sparse matrix of small blocks on the graph of nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace grainlaw {

using Edge = std::pair<std::int32_t, std::int32_t>;  // first < second

// What one vector register holds. A vector over the nodes is one quad per node, its components in
// the lanes (the last is zero); four such vectors together are a quad per node and component, a
// vector in every lane.
struct alignas(32) Quad {
  double lane[4] = {};
};

// Blocks of components x components, column-major, each column one quad, the rows beyond the
// components zero.
struct BlockMatrix {
  int components = 3;
  std::size_t nodes = 0;
  std::vector<Edge> edges;   // unique, ordered
  std::vector<Quad> blocks;  // [nodes] on the diagonal, [edges] (first, second), [edges] the others

  // Blocks in the order of `blocks`; each starts with its first column.
  [[nodiscard]] std::size_t upper(std::size_t edge) const { return nodes + edge; }
  [[nodiscard]] std::size_t lower(std::size_t edge) const { return nodes + edges.size() + edge; }
  [[nodiscard]] Quad* block(std::size_t index) {
    return blocks.data() + index * static_cast<std::size_t>(components);
  }
  [[nodiscard]] const Quad* block(std::size_t index) const {
    return blocks.data() + index * static_cast<std::size_t>(components);
  }
  // Set the graph and zero all values.
  void reset(std::size_t node_count, int component_count, std::span<const Edge> graph);
  void set_zero();
  void subtract_product(std::span<const Quad> x, std::span<Quad> r) const;  // r -= A x
  // r = b - A x, of one vector, and of four together.
  void residual(std::span<const Quad> b, std::span<const Quad> x, std::span<Quad> r) const;
  void residual_of_four(std::span<const Quad> b, std::span<const Quad> x, std::span<Quad> r) const;
};

}  // namespace grainlaw
