// The integration points of a host, taken together: evaluated by many threads, committed all or none.
#pragma once

#include "state/any_state.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <functional>
#include <span>

namespace grainlaw::core {

struct IntegrationPoint {
  AnyState state;
  long cost = 0;  // of its last evaluation, in relaxation steps
};

using PointSpan = std::span<IntegrationPoint* const>;

// What an evaluation of many points came to.
struct Summary {
  grainlaw_status status = GRAINLAW_OK;  // of the first failed point, fatal before recoverable
  std::size_t failed = 0;
  std::size_t first_failed = 0;
  double step_ratio = 1;                               // smallest that a failed point suggests
  char message[sizeof grainlaw_report::message] = "";  // of the first failed point

  // One more point, in any order.
  void add(std::size_t point, grainlaw_status status, const grainlaw_report& report);
};

// The evaluation of one point: its status, and its report. Called by several threads, each for
// another point; does not throw.
using EvaluateOne = std::function<grainlaw_status(std::size_t point, grainlaw_report& report)>;

// Calls evaluate(k, report) once for each point, in `threads` threads at most (<= 0: as many as
// default_threads), the dearest points first, so that no thread is left with one at the end. Order
// is room for as many numbers as there are points. Allocates nothing.
Summary evaluate_all(PointSpan points, std::span<std::size_t> order, const EvaluateOne& evaluate,
                     int threads) noexcept;

// Makes all trials committed. False, and nothing is changed, where a point has none.
bool commit_all(PointSpan points) noexcept;
void revert_all(PointSpan points) noexcept;

}  // namespace grainlaw::core
