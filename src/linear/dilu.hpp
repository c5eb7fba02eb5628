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

// Entries of the same kind in double precision.
template <class Entry>
struct in_double;
template <std::size_t width, class Real>
struct in_double<BlockColumn<width, Real>> {
  using type = BlockColumn<width>;
};
template <std::size_t width, class Real>
struct in_double<Together<width, Real>> {
  using type = Together<width>;
};
template <class Entry>
using InDouble = typename in_double<Entry>::type;

// Preconditioner in Eisenstat's form [eisenstat1981]. A x = b becomes apply(y) = c, with c =
// forward(b), x = backward(y) and a matrix near the identity. Applying it costs a product with A.
// Roots of the diagonal scale a node's unknowns, whose units differ. One vector has a BlockColumn
// per node, several have six Together per node. y and c are in the order of the factors, in double or
// single precision; b and x are in double precision, times a factor per lane.
class Dilu {
 public:
  static constexpr std::size_t width = 8;
  static constexpr std::size_t size = 6;
  using Column = BlockColumn<width>;

  // Factorises in a LevelOrder, so that sweeps read memory in sequence. `regularisation`, positive, is
  // added to the diagonal of M, not of A, since A may have unsupported nodes.
  void factorise(const BlockMatrix<width>& matrix, std::span<const Column> regularisation);

  template <class Entry>
  void forward(std::span<const InDouble<Entry>> b, const double* factor, std::span<Entry> c);
  template <class Entry>
  void apply(std::span<const Entry> y, std::span<Entry> c);
  template <class Entry>
  void backward(std::span<const Entry> y, const double* factor, std::span<InDouble<Entry>> x);

  template <class Real>
  struct Block {
    BlockColumn<width, Real> column[size];
  };
  // Places of a triangle's blocks, row by row.
  struct Triangle {
    std::vector<std::size_t> begin;  // first block of a row; one more entry ends the last
    std::vector<std::int32_t> node;
  };
  template <class Real>
  struct Values {
    std::vector<BlockColumn<width, Real>> scale;  // of x and of b
    std::vector<Block<Real>> inverse, diagonal;   // D^-1; D^-1 times the diagonal blocks, less 2
    std::vector<Block<Real>> lower, upper;        // -D^-1 L and -D^-1 U
    std::vector<BlockColumn<width, Real>> half, rest;  // for apply()
    std::vector<Together<width, Real>> half_together, rest_together;
  };

  // Data that the sweeps read.
  template <class Real>
  struct Factors {
    std::size_t nodes;
    const std::int32_t* node;  // node of a row
    const BlockColumn<width, Real>* scale;
    const Block<Real>* inverse;
    const Block<Real>* diagonal;
    const Triangle& lower;
    const Triangle& upper;
    const Block<Real>* lower_blocks;
    const Block<Real>* upper_blocks;
  };

 private:
  void list_rows();
  template <class Real>
  [[nodiscard]] Values<Real>& values();
  template <class Real>
  [[nodiscard]] Factors<Real> factors() {
    const auto& v = values<Real>();
    return {nodes_,           order_.node().data(), v.scale.data(),
            v.inverse.data(), v.diagonal.data(),    lower_,
            upper_,           v.lower.data(),       v.upper.data()};
  }

  std::size_t nodes_ = 0;
  std::vector<Edge> edges_;
  LevelOrder order_;
  std::vector<std::size_t> block_of_lower_, block_of_upper_;  // index in the matrix
  std::vector<std::int32_t> upper_of_lower_;                  // index in upper_ of the edge
  Triangle lower_, upper_;
  Values<double> double_;
  Values<float> single_;
  std::vector<std::size_t> next_, next_lower_;
};

template <>
inline Dilu::Values<double>& Dilu::values() {
  return double_;
}
template <>
inline Dilu::Values<float>& Dilu::values() {
  return single_;
}

}  // namespace grainlaw::core
