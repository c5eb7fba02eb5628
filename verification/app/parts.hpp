// A step solved in as many parts as it takes.
#pragma once

#include "app/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace verification {

// How an attempt at a part of a step ended.
struct Attempt {
  bool converged = false;
  bool loose = false;                    // converged to a residual beyond the tolerance
  bool stalled = false;                  // every evaluation went well, to no end
  double ratio = 0.5;                    // of the part that seems feasible
  std::string reason = {};               // of the failure
  grainlaw_status status = GRAINLAW_OK;  // of an evaluation that failed
};

// A step that failed in its smallest part too. `status` is of the evaluation that did not succeed, OK
// when all did.
struct StepError : ComputationError {
  StepError(grainlaw_status status_, const std::string& text)
      : ComputationError(text), status(status_) {}
  grainlaw_status status;
};

// Is told of every cut: the part that comes next, of the step, and why.
using CutObserver = std::function<void(double part, const std::string& reason)>;
inline std::string describe_cut(int step, double part, const std::string& reason) {
  return fmt::format("step {} in parts of {:.1e} of it: {}", step, part, reason);
}

// What a part of no more than this share of a step does not end is a jump of P as a function of F and the
// last commit: a packing that has become unstable there rearranges. It is crossed: what lies beyond is
// committed out of balance, and brought to balance from there.
inline constexpr double crossing_part = 1.0 / 16;
inline constexpr int most_crossings = 8;  // of one part; then it ends where it is, as a loose one

inline constexpr int most_cuts = 30;  // a part of 1e-9 of a step is rounding

struct Parts {
  int cuts = 0;
  int loose = 0;
};

// From one time to another: attempt(next, loose) goes from the time of the last success to `next`,
// whole or not at all. After a failure the part is cut by the ratio, at most to a tenth and at least
// to half; after a success the next one is twice as long. When 2^-max_cuts of the step fails, the
// rest is tried once more as a loose part, if they are allowed. Throws StepError, which calls the step
// by its name, when that fails.
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
