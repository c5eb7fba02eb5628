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

// Cycles of BiCGStab in single precision with residuals in double, followed by IDR where they stall.
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
  template <class Entry, class Single>
  struct MemoryOf {
    Krylov<Single> single;
    Krylov<Entry> krylov;
    std::vector<Entry> rest, step, tried;
  };
  template <class Entry>
  auto& memory();

  Dilu dilu_;
  MemoryOf<Column, BlockColumn<width, float>> one_;
  MemoryOf<Together<width>, Together<width, float>> several_;
};

}  // namespace grainlaw::core
