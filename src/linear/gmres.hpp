// GMRES with restarts, for the rare matrix of which the factors are too far from its own.
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

  // x of A x = b (Saad & Schultz 1986), right-preconditioned by the factors of a matrix near A, until
  // the Euclidean norm of the residual is below tolerance x that of b, or a cycle no longer halves
  // it: the caller checks what was reached. A may be singular where b is in its range.
  void solve(const BlockMatrix<width>& matrix, BlockLU<width>& lu, double tolerance,
             std::span<const Column> b, std::span<Column> x);

  // Room for so many nodes, so that solve() allocates nothing; untouched until then.
  void reserve(std::size_t nodes);

 private:
  static constexpr std::size_t directions = 12;  // of a cycle
  static constexpr int cycles = 5;

  std::size_t find_directions(const BlockMatrix<width>& matrix, BlockLU<width>& lu, double length,
                              double enough);
  void rotate(std::size_t k, double& upper, double& lower) const;
  void add_correction(BlockLU<width>& lu, std::size_t count, std::span<Column> x);
  std::span<Column> direction(std::size_t k) { return {basis_.data() + k * nodes_, nodes_}; }

  std::size_t nodes_ = 0;
  std::vector<Column> basis_, work_;
  std::array<std::array<double, directions + 1>, directions> hessenberg_{};  // by column
  std::array<double, directions> cosine_{}, sine_{};
  std::array<double, directions + 1> right_{};  // of the least squares
};

}  // namespace grainlaw::core
