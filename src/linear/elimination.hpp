// Symbolic part of a multifrontal factorisation: elimination order, tree, fronts and their memory.
#pragma once

#include "base/simd.hpp"
#include "linear/block_matrix.hpp"
#include "linear/dense_block.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Multifrontal elimination [duff1983] on a symmetric pattern. Nodes that are eliminated in turn and
// reach the same others form a front, a dense matrix. Its Schur complement is added to the front of
// its parent. The order is approximate minimum degree (SuiteSparse AMD).
class Elimination {
 public:
  // Analyses blocks of so many components on this graph, unless it is the last one analysed. With
  // `keep_order` an order found for another graph of these nodes stays while its fill is as small.
  void analyse(std::size_t nodes, int components, std::span<const Edge> edges,
               bool keep_order = false);

  [[nodiscard]] std::size_t factor_blocks() const;  // in both factors, pivots once

  // Front whose nodes are numbered from its first pivot on. Columns of a panel are whole cache
  // lines.
  struct Front {
    std::size_t first;           // index of its first pivot in the elimination
    std::size_t pivots, others;  // nodes eliminated here, and remaining nodes
    std::size_t rows;            // in rows_ and within_: the others
    std::size_t values;          // in values_: panel of the pivots' rows, then of the others'
    std::size_t left;            // in values_: Schur complement of the others
    std::size_t first_source, last_source;
    std::int32_t parent;  // front whose pivots come first among the others; -1: none
    std::size_t passed;   // number of the others that are pivots of the parent
    bool opens, is_leaf;  // first of its parent's children; without children
  };
  // Block of the matrix, its position in values_, and the distance of its columns there.
  struct Source {
    std::size_t to, stride, block;
  };
  static constexpr std::size_t ahead = 12;  // prefetched sources
  // Rows that are consecutive in a front and in its parent.
  struct Run {
    std::size_t from, to, count;
  };
  // View for the loops over the fronts.
  struct View {
    std::span<const Front> fronts;
    const std::int32_t* rows;
    const std::int32_t* within;
    const std::int32_t* node;
    const Source* sources;
    double* values;
    dense::Pivot* pivots;
    Run* runs;
  };
  [[nodiscard]] View view();

 protected:
  int components_ = 0;
  std::size_t nodes_ = 0;
  std::vector<std::int32_t> node_;  // index in the elimination -> node

 private:
  bool analysed_ = false;  // the graph below, completely
  bool ordered_ = false;   // in the order of its own graph
  double fill_ = 0;        // blocks below the diagonal
  double own_fill_ = 0;    // blocks below the diagonal in an order of its own
  std::vector<Edge> edges_;
  std::vector<std::int32_t> position_;  // node -> index in the elimination
  std::vector<Front> fronts_;           // children before their parents
  std::vector<std::int32_t> rows_;      // indices, ascending within a front
  std::vector<std::int32_t> within_;    // these rows as nodes of the parent
  std::vector<Source> sources_;         // off the diagonal, by fronts
  simd::Column<double> values_;         // panels, factorised in place; then Schur complements
  std::vector<dense::Pivot> pivots_;    // forms of the diagonal blocks, by index
  std::vector<Run> runs_;               // of one front at a time
  // Memory of the analysis, by node, by index and by front.
  std::vector<std::int32_t> amd_, neighbours_, parent_, ancestor_, child_, sibling_, order_, below_;
  std::vector<std::int32_t> structure_, mark_, front_of_;
  std::vector<std::size_t> neighbours_begin_, structure_begin_, next_;

  void list_neighbours();
  void order();
  void find_tree();
  void sort_by_tree();
  void find_structure();
  void find_fronts();
  void link_fronts();
  void lay_out_fronts();
  void find_sources();
};

}  // namespace grainlaw::core
