// Evaluation of one state and of a batch; commit and revert.
#include "api/evaluate_point.hpp"
#include "api/evaluate_points.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "api/report.hpp"
#include "base/error.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

using namespace grainlaw::core;

namespace {

using States = std::span<grainlaw_state* const>;

grainlaw_status check_states(States states) {
  for (const grainlaw_state* state : states)
    if (const grainlaw_status status = api::check_owned(state); status != GRAINLAW_OK)
      return status;
  for (const grainlaw_state* state : states)
    if (state->point.state.dimension() != states[0]->point.state.dimension())
      return GRAINLAW_BAD_ARGUMENT;
  std::vector<const grainlaw_state*> sorted(states.begin(), states.end());
  std::sort(sorted.begin(), sorted.end(), std::less<>());
  const bool distinct = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  return distinct ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
}

}  // namespace

grainlaw_report grainlaw_report_default(void) {
  grainlaw_report report{};
  report.size = sizeof report;
  return report;
}

grainlaw_status grainlaw_evaluate(grainlaw_state* handle, const double* F, unsigned want, double* P,
                                  double* A, grainlaw_report* report) {
  if (const auto status = api::check_owned(handle); status != GRAINLAW_OK) return status;
  if (F == nullptr) return GRAINLAW_NULL_POINTER;
  if (const auto status = api::Reports(report).check(1); status != GRAINLAW_OK) return status;
  grainlaw_report full = grainlaw_report_default();
  const grainlaw_status status =
      api::known_want(want)
          ? api::evaluate_point(handle->point, F, want, P, A, full)
          : api::guarded([&] { throw Error(GRAINLAW_BAD_ARGUMENT, api::fault_of_want(want)); },
                         {full.message, sizeof full.message});
  if (report != nullptr) api::copy_out(full, report);
  return status;
}

grainlaw_status grainlaw_evaluate_batch(std::size_t n, grainlaw_state* const* states,
                                        const double* F, unsigned want, double* P, double* A,
                                        grainlaw_status* status, grainlaw_report* reports,
                                        int threads) {
  if (n == 0) return GRAINLAW_OK;
  if (states == nullptr || F == nullptr || status == nullptr) return GRAINLAW_NULL_POINTER;
  const api::CancellationOff cancellation;
  const api::PointArrays arrays{F, want, P, A, status, api::Reports(reports)};
  std::vector<IntegrationPoint*> points;
  std::vector<std::size_t> order;
  const grainlaw_status checked = api::guarded([&] {
    if (const auto found = check_states({states, n}); found != GRAINLAW_OK) return found;
    if (const auto found = api::check(arrays, n, states[0]->point.state.dimension());
        found != GRAINLAW_OK)
      return found;
    points.reserve(n);
    for (grainlaw_state* const state : States(states, n)) points.push_back(&state->point);
    order.resize(n);
    return GRAINLAW_OK;
  });
  if (checked != GRAINLAW_OK) {
    std::fill_n(status, n, checked);
    return checked;
  }
  return api::evaluate_points(points, order, arrays, threads).status;
}

grainlaw_status grainlaw_state_set_time_step(grainlaw_state* handle, double time_step) {
  if (const auto status = api::check_owned(handle); status != GRAINLAW_OK) return status;
  if (!(time_step >= 0 && std::isfinite(time_step))) return GRAINLAW_BAD_ARGUMENT;
  handle->point.state.set_time_step(time_step);
  return GRAINLAW_OK;
}

grainlaw_status grainlaw_commit(grainlaw_state* handle) {
  if (const auto status = api::check_owned(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { return handle->point.commit() ? GRAINLAW_OK : GRAINLAW_NO_TRIAL; });
}

grainlaw_status grainlaw_revert(grainlaw_state* handle) {
  if (const auto status = api::check_owned(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { handle->point.state.revert(); });
}
