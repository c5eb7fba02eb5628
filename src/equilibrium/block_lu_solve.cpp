// The solves: forward and backward substitution.
#include "equilibrium/block_lu_loops.hpp"

#include "room.hpp"

#include <algorithm>

namespace grainlaw {

using namespace block_lu;

namespace {

// In the elimination's order.
template <int b>
GRAINLAW_INLINE void substitute(const Factor& f, double* y) {
  constexpr std::size_t size = b * width;
  const double* const values = f.values;
  const auto subtract = [&](std::size_t first, std::size_t last, const Lanes& x) {
    Lanes each[b];
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) each[c] = Lanes{} + x[c];
    for (std::size_t slot = first; slot < last; ++slot) {
      double* const to = y + static_cast<std::size_t>(f.rows[slot]) * width;
      const Block<b> block = load_block<b>(values + slot * size);
      Lanes sum = load(to);
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) sum -= block.column[c] * each[c];
      store(to, sum);
    }
  };
  for (std::size_t j = 0; j < f.nodes; ++j) {
    subtract(f.diagonal[j] + 1, f.begin[j + 1], load(y + j * width));
  }
  for (std::size_t j = f.nodes; j-- > 0;) {
    const Block<b> inverse = load_block<b>(values + f.diagonal[j] * size);
    const double* const from = y + j * width;
    Lanes x = inverse.column[0] * from[0];
#pragma GCC unroll 3
    for (std::size_t c = 1; c < b; ++c) x += inverse.column[c] * from[c];
    store(y + j * width, x);
    subtract(f.begin[j], f.diagonal[j], x);
  }
}

GRAINLAW_CLONES void substitute_3(const Factor& f, double* y) { substitute<3>(f, y); }
GRAINLAW_CLONES void substitute_2(const Factor& f, double* y) { substitute<2>(f, y); }

// A vector in every lane.
template <int b>
GRAINLAW_INLINE void substitute_four(const Factor& f, double* y) {
  constexpr std::size_t size = b * width;
  const double* const values = f.values;
  const auto subtract = [&](std::size_t first, std::size_t last, const Block<b>& x) {
    for (std::size_t slot = first; slot < last; ++slot) {
      double* const to = y + static_cast<std::size_t>(f.rows[slot]) * size;
      const double* const block = values + slot * size;
      Block<b> sum = load_block<b>(to);
#pragma GCC unroll 3
      for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 3
        for (std::size_t r = 0; r < b; ++r) sum.column[r] -= block[c * width + r] * x.column[c];
      }
      store_block<b>(to, sum);
    }
  };
  for (std::size_t j = 0; j < f.nodes; ++j) {
    subtract(f.diagonal[j] + 1, f.begin[j + 1], load_block<b>(y + j * size));
  }
  for (std::size_t j = f.nodes; j-- > 0;) {
    const double* const inverse = values + f.diagonal[j] * size;
    const Block<b> from = load_block<b>(y + j * size);
    Block<b> x;
#pragma GCC unroll 3
    for (std::size_t r = 0; r < b; ++r) {
      x.column[r] = inverse[r] * from.column[0];
#pragma GCC unroll 3
      for (std::size_t c = 1; c < b; ++c) x.column[r] += inverse[c * width + r] * from.column[c];
    }
    store_block<b>(y + j * size, x);
    subtract(f.begin[j], f.diagonal[j], x);
  }
}

GRAINLAW_CLONES void substitute_four_3(const Factor& f, double* y) { substitute_four<3>(f, y); }
GRAINLAW_CLONES void substitute_four_2(const Factor& f, double* y) { substitute_four<2>(f, y); }

}  // namespace

void BlockLU::solve(std::span<Quad> x) {
  resize_with_room(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) work_[j] = x[static_cast<std::size_t>(node_[j])];
  const Factor f = factor();
  components_ == 3 ? substitute_3(f, work_.data()->lane) : substitute_2(f, work_.data()->lane);
  for (std::size_t j = 0; j < nodes_; ++j) x[static_cast<std::size_t>(node_[j])] = work_[j];
}

void BlockLU::solve_four(std::span<Quad> x) {
  const auto b = static_cast<std::size_t>(components_);
  resize_with_room(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&x[static_cast<std::size_t>(node_[j]) * b], b, &work_[j * b]);
  }
  const Factor f = factor();
  double* y = work_.data()->lane;
  components_ == 3 ? substitute_four_3(f, y) : substitute_four_2(f, y);
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&work_[j * b], b, &x[static_cast<std::size_t>(node_[j]) * b]);
  }
}

}  // namespace grainlaw
