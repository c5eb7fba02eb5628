// GMRES with restarts, for the rare matrix whose factors are too far from it.
#pragma once

#include "linear/block_lu.hpp"
#include "linear/block_matrix.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

template <std::size_t width>
class Gmres {
 public:
  using Column = BlockColumn<width>;

  // Solves A x = b [saad1986], right-preconditioned by the factors of a matrix near A. Stops when
  // the Euclidean norm of the residual is below tolerance x that of b, or a cycle no longer halves
  // it. The caller checks the residual. A may be singular if b is in its range.
  void solve(const BlockMatrix<width>& matrix, BlockLU<width>& lu, double tolerance,
             std::span<const Column> b, std::span<Column> x);

  // Reserves memory for so many nodes, untouched until then, so that solve() allocates nothing.
  void reserve(std::size_t nodes);

 private:
  static constexpr std::size_t directions = 12;  // per cycle
  static constexpr int cycles = 5;

  std::size_t find_directions(const BlockMatrix<width>& matrix, BlockLU<width>& lu, double length,
                              double enough);
  void rotate(std::size_t k, double& upper, double& lower) const;
  void add_correction(BlockLU<width>& lu, std::size_t count, std::span<Column> x);
  std::span<Column> direction(std::size_t k) { return {basis_.data() + k * nodes_, nodes_}; }

  std::size_t nodes_ = 0;
  std::vector<Column> basis_, work_;
  std::array<std::array<double, directions + 1>, directions> hessenberg_{};  // column-major
  std::array<double, directions> cosine_{}, sine_{};
  std::array<double, directions + 1> right_{};  // of the least squares
};

}  // namespace grainlaw::core
