// Linear solves by Krylov methods to a residual that is asked for.
#pragma once

#include "linear/krylov.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

struct IterativeOptions {
  double tolerance;  // largest entry of the residual, relative to that of b [-]
  double floor;      // b of smaller entries counts as one of these
  int products;      // of one method before another goes on
};

// BiCGStab, and IDR from where that stalls.
class Iterative {
 public:
  static constexpr std::size_t width = Dilu::width;
  using Column = BlockColumn<width>;

  // As Dilu::factorise(); for the solves that follow.
  void prepare(const BlockMatrix<width>& matrix, std::span<const Column> ground);

  // x of A x = b, of one vector or of several together. Returns the largest residual as the tolerance is meant,
  // of the worst lane.
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
