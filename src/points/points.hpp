// Many integration points of a host: evaluated by threads, committed all or none.
#pragma once

#include "state/any_state.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace grainlaw::core {

// A tangent beside the state that it belongs to.
struct KeptTangent {
  TangentKind kind = TangentKind::none;
  std::vector<double> values;  // [dim^4], meant unless the kind is none [Pa]
};

struct IntegrationPoint {
  AnyState state;
  long cost = 0;       // of the last evaluation, in relaxation steps
  double seconds = 0;  // processor time of the last evaluation
  bool keeps_tangents = false;
  KeptTangent committed_tangent{}, trial_tangent{};

  // Evaluates as State::evaluate() does; tells its cost and keeps the tangent.
  grainlaw_status evaluate(const double* F, TangentKind kind, double* P, double* A,
                           grainlaw_report& report);
  bool commit();  // returns false without a trial

  // P and A of the committed state; each may be null. A comes from a copy unless it was kept.
  grainlaw_status answer(TangentKind kind, double* P, double* A, grainlaw_report& report) const;
};

using PointSpan = std::span<IntegrationPoint* const>;

// Summary of an evaluation of many points.
struct Summary {
  grainlaw_status status = GRAINLAW_OK;  // of the first failed point, fatal before recoverable
  std::size_t failed = 0;
  std::size_t first_failed = 0;
  double step_ratio = 1;                               // smallest suggestion of the failed points
  char message[sizeof grainlaw_report::message] = "";  // of the first failed point

  // Adds one point; any order gives one result.
  void add(std::size_t point, grainlaw_status status, const grainlaw_report& report);
};

// Evaluates one point and returns its status and report. Several threads call it for different
// points; it does not throw.
using EvaluateOne = std::function<grainlaw_status(std::size_t point, grainlaw_report& report)>;

// Calls evaluate(k, report) once per point in at most `threads` threads (<= 0: default_threads()),
// the most expensive points first, which balances the threads. `order` is a workspace with one
// number per point. Does not allocate.
Summary evaluate_all(PointSpan points, std::span<std::size_t> order, const EvaluateOne& evaluate,
                     int threads) noexcept;

[[nodiscard]] bool have_trials(PointSpan points) noexcept;
// Commits all trials, which there have to be.
void commit_all(PointSpan points) noexcept;
void revert_all(PointSpan points) noexcept;

// Squared norm of the change of P, from the committed states to the trials, that the committed tangents
// do not explain [Pa^2]; negative where a point has no committed tangent.
[[nodiscard]] double unforeseen(PointSpan points) noexcept;

}  // namespace grainlaw::core
