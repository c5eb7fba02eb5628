// Incomplete LU factors of a matrix of blocks of six: M = (D + L) D^-1 (D + U) with the triangles L and
// U of the matrix itself, and D such that the diagonal blocks of M are the matrix's (DILU).
#pragma once

#include "linear/block_matrix.hpp"
#include "linear/level_order.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// A system A x = b is solved as one of y, the matrix of which is near the identity: apply(y) = c with
// c = forward(b), and x = backward(y). By Eisenstat (1981) that costs as much as a product with A. A
// node's unknowns have different units: they are scaled by the roots of the diagonal on the way.
// One vector has a BlockColumn for every node; several together have six Together for every node. Vectors y and c are
// in the order of the factors.
class Dilu {
 public:
  static constexpr std::size_t width = 8;
  static constexpr std::size_t size = 6;
  using Column = BlockColumn<width>;

  // In a LevelOrder: what a sweep reads lies together. `ground`, all of it positive, is added to the
  // diagonal of M, not of A: there may be nodes that nothing holds.
  void factorise(const BlockMatrix<width>& matrix, std::span<const Column> ground);

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
    std::vector<std::size_t> begin;  // of a row; one more ends the last
    std::vector<std::int32_t> node;
    std::vector<Block> block;
  };

  // What the sweeps read.
  struct Factors {
    std::size_t nodes;
    const std::int32_t* node;  // of a row
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
  std::vector<std::size_t> block_of_lower_, block_of_upper_;  // of the matrix
  std::vector<std::int32_t> upper_of_lower_;                  // the same edge in upper_
  std::vector<Column> scale_;                                 // of x, and of b
  std::vector<Block> inverse_, diagonal_;  // D^-1; D^-1 times the diagonal blocks, less 2
  Triangle lower_, upper_;                 // -D^-1 L and -D^-1 U
  std::vector<std::size_t> next_, next_lower_;
  std::vector<Column> half_, rest_;  // of apply()
  std::vector<Together<width>> half_together_, rest_together_;
};

}  // namespace grainlaw::core
