// Ranks played by threads, each with a set of its own that shares its failures.
#pragma once

#include "points_support.hpp"

#include <algorithm>
#include <array>
#include <barrier>
#include <functional>
#include <thread>

namespace grainlaw::test {

inline constexpr int ranks = 3;

// What MPI_Allreduce does, among threads.
class Allreduce {
 public:
  void operator()(int rank, double* values, int n, grainlaw_op op) {
    const std::span mine(values, static_cast<std::size_t>(n));
    all_[static_cast<std::size_t>(rank)].assign(mine.begin(), mine.end());
    barrier_.arrive_and_wait();
    for (std::size_t k = 0; k < mine.size(); ++k) {
      mine[k] = all_[0][k];
      for (std::size_t r = 1; r < ranks; ++r)
        mine[k] = op == GRAINLAW_MIN ? std::min(mine[k], all_[r][k]) : mine[k] + all_[r][k];
    }
    barrier_.arrive_and_wait();
  }

 private:
  std::barrier<> barrier_{ranks};
  std::array<std::vector<double>, ranks> all_;
};

struct Rank {
  Allreduce* all;
  int number;
  static void reduce(void* context, double* values, int n, grainlaw_op op) {
    const Rank& rank = *static_cast<Rank*>(context);
    (*rank.all)(rank.number, values, n, op);
  }
};

// Runs on_rank(rank, set) on each rank; the last one has no points.
inline void on_ranks(const std::function<void(int, Points&)>& on_rank) {
  Allreduce all;
  std::vector<std::thread> threads;
  for (int r = 0; r < ranks; ++r) {
    threads.emplace_back([&, r] {
      Rank rank{&all, r};
      Points set(material(), r == ranks - 1 ? 0 : points);
      set.share(r, Rank::reduce, &rank);
      on_rank(r, set);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace grainlaw::test
