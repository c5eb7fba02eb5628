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

// Blocks of components x components, column-major, each column padded to `stride` doubles.
struct BlockMatrix {
  int components = 3;
  int stride = 4;
  std::size_t nodes = 0;
  std::vector<Edge> edges;           // unique, ordered
  std::vector<double> diagonal;      // [nodes] blocks
  std::vector<double> upper, lower;  // [edges] blocks (first, second) and (second, first)

  [[nodiscard]] std::size_t block_size() const {
    return static_cast<std::size_t>(components * stride);
  }
  // Set the graph and zero all values.
  void reset(std::size_t node_count, int component_count, std::span<const Edge> graph);
  void set_zero();
  // y = A x; vectors are component-major over nodes.
  void multiply(std::span<const double> x, std::span<double> y) const;
};

// Left-looking LU on a symmetric pattern; order by approximate minimum degree (SuiteSparse AMD).
class BlockLU {
 public:
  // Symbolic analysis; kept when the graph is the one analysed last.
  void analyse(const BlockMatrix& matrix);
  // Numeric factorisation. False when a pivot block is singular.
  bool factorise(const BlockMatrix& matrix);
  // x = A^-1 b, component-major over nodes; x and b may be the same.
  void solve(std::span<const double> b, std::span<double> x);

  [[nodiscard]] std::size_t factor_blocks() const { return rows_.size(); }

 private:
  int components_ = 0;
  std::size_t nodes_ = 0;
  std::vector<Edge> edges_;
  std::vector<std::int32_t> position_;                // node -> place in the elimination
  std::vector<std::size_t> begin_, diagonal_;         // per column: first slot, slot of the pivot
  std::vector<std::int32_t> rows_;                    // per slot, ascending within a column
  std::vector<std::size_t> upper_slot_, lower_slot_;  // per edge
  std::vector<double> values_;                        // pivots inverted in place
  std::vector<double> work_;
  std::vector<std::int32_t> where_;
  // Memory of the analysis.
  std::vector<std::int32_t> amd_, adjacency_, parent_, ancestor_, reach_;
  std::vector<std::size_t> adjacency_begin_, reach_begin_, below_;

  void order(std::size_t nodes, std::span<const Edge> edges);
  void find_reach();
};

// x = A^-1 b by a pivoting sparse LU (Eigen), for the rare matrix that BlockLU cannot solve. Slow
// and allocating. False when singular.
bool solve_with_pivoting(const BlockMatrix& matrix, std::span<const double> b, std::span<double> x);

}  // namespace grainlaw
