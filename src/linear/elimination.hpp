// The symbolic part of a factorisation by fronts: the order of elimination, its tree, its fronts and
// where they lie.
#pragma once

#include "base/simd.hpp"
#include "linear/block_matrix.hpp"
#include "linear/dense_block.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Multifrontal (Duff & Reid 1983) on a symmetric pattern: nodes that are eliminated one after the
// other and see the same others make a front, a dense matrix, and what their elimination leaves is
// added to the front of the next. The order is by approximate minimum degree (SuiteSparse AMD).
class Elimination {
 public:
  // Of blocks of so many components on this graph; kept when it is the one analysed last. Where it
  // may be kept, an order found for another graph of these nodes serves as long as its fill is as small.
  void analyse(std::size_t nodes, int components, std::span<const Edge> edges,
               bool keep_order = false);

  [[nodiscard]] std::size_t factor_blocks() const;  // of both factors, pivots once

  // Its nodes are numbered from the first pivot on; a panel's columns are of whole cache lines.
  struct Front {
    std::size_t first;           // place of its first pivot in the elimination
    std::size_t pivots, others;  // nodes that are eliminated here, and that are left
    std::size_t rows;            // in rows_ and within_: the others
    std::size_t values;          // in values_: panel of the pivots' rows, then of the others'
    std::size_t left;            // in values_: what the elimination leaves of the others
    std::size_t first_source, last_source;
    std::int32_t parent;  // the front whose pivots come first among the others; -1: none
    std::size_t passed;   // of the others, pivots of the parent
    bool opens, is_leaf;  // first of its parent's children; without children
  };
  // A block of the matrix, and where in values_ it goes, with the distance of its columns.
  struct Source {
    std::size_t to, stride, block;
  };
  static constexpr std::size_t ahead = 12;  // of them on their way to the processor
  // Rows that follow each other in a front and in its parent.
  struct Run {
    std::size_t from, to, count;
  };
  // As the loops over the fronts see it.
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
  std::vector<std::int32_t> node_;  // place in the elimination -> node

 private:
  bool analysed_ = false;  // the graph below, to the end
  bool ordered_ = false;   // in the order of its own graph
  double fill_ = 0;        // blocks below the diagonal
  double own_fill_ = 0;    // the same in an order of its own
  std::vector<Edge> edges_;
  std::vector<std::int32_t> position_;  // node -> place in the elimination
  std::vector<Front> fronts_;           // children before their parents
  std::vector<std::int32_t> rows_;      // places, ascending within a front
  std::vector<std::int32_t> within_;    // the same as nodes of the parent
  std::vector<Source> sources_;         // off the diagonal, by fronts
  simd::Column<double> values_;         // panels, factorised in place; then what fronts leave
  std::vector<dense::Pivot> pivots_;    // how the diagonal blocks are kept, by places
  std::vector<Run> runs_;               // of one front at a time
  // Memory of the analysis: by nodes, by places, and by fronts.
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
  void place_fronts();
  void find_sources();
};

}  // namespace grainlaw::core
