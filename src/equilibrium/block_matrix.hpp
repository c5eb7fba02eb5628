// Sparse matrix of small blocks on the graph of nodes, and its LU factorisation with the blocks on
// the diagonal as pivots, in an order found once per graph.
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

// Left-looking LU on a symmetric pattern; order by approximate minimum degree (SuiteSparse AMD).
class BlockLU {
 public:
  struct Factor;  // how the loops see it

  // Symbolic analysis; kept when the graph is the one analysed last. Where it may be
  // kept, an order found for another graph of these nodes serves as long as its fill is as small.
  void analyse(const BlockMatrix& matrix, bool keep_order = false);
  // Numeric factorisation of the matrix plus diag(added), one quad per node or none. False when a
  // pivot block is singular.
  bool factorise(const BlockMatrix& matrix, std::span<const Quad> added = {});
  // x = A^-1 x, of one vector, and of four together.
  void solve(std::span<Quad> x);
  void solve_four(std::span<Quad> x);

  [[nodiscard]] std::size_t factor_blocks() const { return rows_.size(); }

 private:
  struct Source {
    std::int32_t slot, block;  // of the factor, of the matrix
  };

  int components_ = 0;
  bool ordered_ = false;  // in the order of its own graph
  double own_fill_ = 0;   // of the factor in such an order [blocks below the diagonal]
  std::size_t nodes_ = 0;
  std::vector<Edge> edges_;
  std::vector<std::int32_t> position_;     // node -> place in the elimination
  std::vector<std::int32_t> node_;         // and back
  std::vector<std::size_t> begin_;         // per column: its first slot
  std::vector<std::size_t> diagonal_;      // the slot of its pivot
  std::vector<char> paired_;               // below the next pivot it has the rows of the next
  std::vector<std::int32_t> rows_;         // per slot, ascending within a column
  std::vector<std::size_t> source_begin_;  // per column
  std::vector<Source> sources_;            // off the diagonal
  std::vector<Quad> values_;               // pivots inverted in place
  std::vector<Quad> work_;
  std::vector<std::int32_t> where_;
  // Memory of the analysis.
  std::vector<std::int32_t> amd_, adjacency_, parent_, ancestor_, reach_;
  std::vector<std::size_t> adjacency_begin_, reach_begin_, below_;

  Factor factor(std::span<const Quad> added = {}, const BlockMatrix* matrix = nullptr);
  void order(std::size_t nodes, std::span<const Edge> edges);
  void find_reach();
  void find_columns();
  void find_sources();
};

}  // namespace grainlaw
