// Linear solves by Krylov methods to a given residual.
#pragma once

#include "linear/krylov.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

struct IterativeOptions {
  double tolerance;  // largest entry of the residual, relative to that of b [-]
  double floor;      // lower bound of the largest entry of b
  int products;      // most products of one method before the next one
};

// BiCGStab, followed by IDR where that stalls.
class Iterative {
 public:
  static constexpr std::size_t width = Dilu::width;
  using Column = BlockColumn<width>;

  // Prepares the solves that follow; see Dilu::factorise().
  void prepare(const BlockMatrix<width>& matrix, std::span<const Column> regularisation);

  // Solves A x = b for one vector or several. Returns the largest residual over the lanes, in the
  // measure of the tolerance.
  template <class Entry>
  double solve(const BlockMatrix<width>& matrix, std::span<const Entry> b, std::span<Entry> x,
               const IterativeOptions& options);

  int products = 0;  // of all solves

 private:
  template <class Entry>
  struct Memory {
    Krylov<Entry> krylov;
    std::vector<Entry> rest, step, tried;
  };
  template <class Entry>
  Memory<Entry>& memory();

  Dilu dilu_;
  Memory<Column> one_;
  Memory<Together<width>> several_;
};

}  // namespace grainlaw::core
