// CPU time of the calling thread, and of one evaluation.
#pragma once

#include "app/cpu_time.hpp"
#include "app/library.hpp"

#include <algorithm>

namespace verification {

inline double cpu_milliseconds() { return 1e3 * cpu_seconds(); }

struct TimedEvaluation {
  Evaluation evaluation;
  double cpu = 0;  // [ms]
};

// The increment from the committed state to `deformation`; the best of a few, since the machine may
// be doing other things. One that takes longer than `long_enough` [ms] is not done again.
inline TimedEvaluation time_evaluation(const State& state, const Tensor& deformation, unsigned want,
                                       double long_enough = 100) {
  constexpr int repetitions = 3;
  TimedEvaluation result;
  for (int k = 0; k < repetitions; ++k) {
    State copy = state;
    const double start = cpu_milliseconds();
    result.evaluation = evaluate(copy, deformation, want);
    const double spent = cpu_milliseconds() - start;
    result.cpu = k == 0 ? spent : std::min(result.cpu, spent);
    if (result.cpu > long_enough) break;
  }
  return result;
}

}  // namespace verification
