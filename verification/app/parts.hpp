// Step control: a step is divided into parts until each converges.
#pragma once

#include "app/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace verification {

// Result of an attempt at a part of a step.
struct Attempt {
  bool converged = false;
  bool loose = false;                    // converged beyond the tolerance
  bool stalled = false;                  // all evaluations succeeded, without convergence
  double ratio = 0.5;                    // suggested factor on the part
  std::string reason = {};               // reason of the failure
  grainlaw_status status = GRAINLAW_OK;  // of a failed evaluation
};

// Largest change of F per Newton correction (Frobenius norm); longer ones are made in parts [-]. A
// point takes a stretch of 30 %, and a smaller load step does not shorten what an unstable body asks.
inline constexpr double largest_correction = 0.1;

// A step that failed at its smallest part. `status` is that of the failed evaluation, OK when all
// succeeded.
struct StepError : ComputationError {
  StepError(grainlaw_status status_, const std::string& text)
      : ComputationError(text), status(status_) {}
  grainlaw_status status;
};

// Called at every cut with the next part over the step, and the reason.
using CutObserver = std::function<void(double part, const std::string& reason)>;
inline std::string describe_cut(int step, double part, const std::string& reason) {
  return fmt::format("step {} in parts of {:.1e} of it: {}", step, part, reason);
}

// Largest part over its step at which a failure counts as a jump of P(F). The packing is unstable
// there and rearranges. The jump is crossed: the state beyond is committed out of balance, then
// balanced.
inline constexpr double crossing_part = 1.0 / 16;
inline constexpr int most_crossings = 8;  // per part; then it is accepted as loose

inline constexpr int most_cuts = 30;  // smaller parts are below rounding

struct Parts {
  int cuts = 0;
  int loose = 0;
};

// Advances from one time to another. attempt(next, loose) goes from the last success to `next`,
// completely or not at all. A failure multiplies the part by the suggested ratio, between 0.1 and
// 0.5; a success doubles it. When 2^-max_cuts of the step fails, the rest is tried once as a loose
// part, if allowed. Throws StepError with the name of the step.
template <class Function>
Parts solve_in_parts(double from, double to, const std::string& name, int max_cuts,
                     bool loose_allowed, Function&& attempt, const CutObserver& observe_cut = {}) {
  const double smallest = std::ldexp(to - from, -max_cuts);
  double done = from;
  double part = to - from;
  bool loose = false;
  Parts parts;
  for (;;) {
    const double next = done + part > to - 1e-9 * (to - from) ? to : done + part;
    const Attempt result = attempt(next, loose);
    if (result.converged) {
      part = std::min(to - next, 2 * (next - done));
      done = next;
      loose = false;
      parts.loose += result.loose ? 1 : 0;
      if (done < to) continue;
      return parts;
    }
    ++parts.cuts;
    part = (next - done) * std::clamp(result.ratio, 0.1, 0.5);
    if (part >= smallest && to > from) {
      if (observe_cut) observe_cut(part / (to - from), result.reason);
      continue;
    }
    if (loose || !loose_allowed) {
      const std::string where =
          to > from ? fmt::format(" {:.3g} % along, in parts of {:.1e} of it too",
                                  100 * (done - from) / (to - from), (next - done) / (to - from))
                    : "";
      throw StepError(result.status, fmt::format("{} failed{}: {}", name, where, result.reason));
    }
    loose = true;
    ++parts.loose;
    part = to - done;
  }
}

}  // namespace verification
