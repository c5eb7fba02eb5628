// Incomplete LU factors (DILU) of a matrix of blocks of six: M = (D + L) D^-1 (D + U). L and U are
// the matrix's triangles; D makes the diagonal blocks of M those of the matrix.
#pragma once

#include "linear/block_matrix.hpp"
#include "linear/level_order.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Preconditioner in Eisenstat's form [eisenstat1981]. A x = b becomes apply(y) = c, with c =
// forward(b), x = backward(y) and a matrix near the identity. Applying it costs a product with A.
// Roots of the diagonal scale a node's unknowns, whose units differ. One vector has a BlockColumn
// per node, several have six Together per node. y and c are in the order of the factors.
class Dilu {
 public:
  static constexpr std::size_t width = 8;
  static constexpr std::size_t size = 6;
  using Column = BlockColumn<width>;

  // Factorises in a LevelOrder, so that sweeps read memory in sequence. `regularisation`, positive, is
  // added to the diagonal of M, not of A, since A may have unsupported nodes.
  void factorise(const BlockMatrix<width>& matrix, std::span<const Column> regularisation);

  template <class Entry>
  void forward(std::span<const Entry> b, std::span<Entry> c) const;
  template <class Entry>
  void apply(std::span<const Entry> y, std::span<Entry> c);
  template <class Entry>
  void backward(std::span<const Entry> y, std::span<Entry> x);

  struct Block {
    Column column[size];
  };
  // Blocks of a triangle, row by row.
  struct Triangle {
    std::vector<std::size_t> begin;  // first block of a row; one more entry ends the last
    std::vector<std::int32_t> node;
    std::vector<Block> block;
  };

  // Data that the sweeps read.
  struct Factors {
    std::size_t nodes;
    const std::int32_t* node;  // node of a row
    const Column* scale;
    const Block* inverse;
    const Block* diagonal;
    const Triangle& lower;
    const Triangle& upper;
  };

 private:
  void list_rows();
  [[nodiscard]] Factors factors() const {
    return {nodes_, order_.node().data(), scale_.data(), inverse_.data(), diagonal_.data(), lower_,
            upper_};
  }

  std::size_t nodes_ = 0;
  std::vector<Edge> edges_;
  LevelOrder order_;
  std::vector<std::size_t> block_of_lower_, block_of_upper_;  // index in the matrix
  std::vector<std::int32_t> upper_of_lower_;                  // index in upper_ of the edge
  std::vector<Column> scale_;                                 // of x and of b
  std::vector<Block> inverse_, diagonal_;  // D^-1; D^-1 times the diagonal blocks, less 2
  Triangle lower_, upper_;                 // -D^-1 L and -D^-1 U
  std::vector<std::size_t> next_, next_lower_;
  std::vector<Column> half_, rest_;  // for apply()
  std::vector<Together<width>> half_together_, rest_together_;
};

}  // namespace grainlaw::core
