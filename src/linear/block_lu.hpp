// LU factorisation of a block matrix, front by front, with diagonal blocks as pivots.
#pragma once

#include "linear/block_matrix.hpp"
#include "linear/elimination.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

template <std::size_t width>
class BlockLU {
 public:
  using Column = BlockColumn<width>;

  // Analyses the graph; see Elimination::analyse().
  void analyse(const BlockMatrix<width>& matrix, bool keep_order = false) {
    elimination_.analyse(matrix.nodes, matrix.components, matrix.edges, keep_order);
    nodes_ = matrix.nodes;
    components_ = static_cast<std::size_t>(matrix.components);
  }
  // Factorises the matrix plus diag(added), with one column of `added` per node or none. Returns
  // false if a pivot block is singular.
  bool factorise(const BlockMatrix<width>& matrix, std::span<const Column> added = {});
  // Replaces x by A^-1 x, for one vector.
  void solve(std::span<Column> x);
  // Replaces x by A^-1 x, for several vectors.
  void solve_together(std::span<Together<width>> x);

  [[nodiscard]] std::size_t factor_blocks() const { return elimination_.factor_blocks(); }

 private:
  Elimination elimination_;
  std::size_t nodes_ = 0, components_ = 0;
  std::vector<Column> work_;  // for the solves
  std::vector<Together<width>> work_together_;
};

}  // namespace grainlaw::core
