// Evaluation of one point and of a batch, and the fate of the trial.
#include "api/evaluate_point.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "api/report.hpp"
#include "api/workers.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

using namespace grainlaw;

namespace {

using States = std::span<grainlaw_state* const>;

// Bytes from one report to the next in the caller's array, whose struct may be an earlier one.
std::size_t report_stride(const grainlaw_report* reports) {
  constexpr std::size_t alignment = alignof(grainlaw_report);
  return (api::claimed_size(reports) + alignment - 1) / alignment * alignment;
}

void* report_at(grainlaw_report* reports, std::size_t stride, std::size_t k) {
  return reports == nullptr ? nullptr : reinterpret_cast<char*>(reports) + k * stride;
}

grainlaw_status check_states(States states) {
  for (const grainlaw_state* state : states)
    if (const grainlaw_status status = api::check_handle(state); status != GRAINLAW_OK)
      return status;
  for (const grainlaw_state* state : states)
    if (state->state.material().packing.dimension != states[0]->state.material().packing.dimension)
      return GRAINLAW_BAD_ARGUMENT;
  std::vector<const grainlaw_state*> sorted(states.begin(), states.end());
  std::sort(sorted.begin(), sorted.end(), std::less<>());
  const bool distinct = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  return distinct ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
}

grainlaw_status check_reports(grainlaw_report* reports, std::size_t n) {
  if (reports == nullptr) return GRAINLAW_OK;
  const std::size_t size = api::claimed_size(reports);
  if (!api::known_report_size(size)) return GRAINLAW_BAD_REPORT;
  for (std::size_t k = 0; k < n; ++k)
    if (api::claimed_size(report_at(reports, report_stride(reports), k)) != size)
      return GRAINLAW_BAD_REPORT;
  return GRAINLAW_OK;
}

// The dearest points first, so that no thread is left with one at the end.
std::vector<std::size_t> by_cost(States states) {
  std::vector<std::size_t> order(states.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return states[a]->last_cost > states[b]->last_cost;
  });
  return order;
}

// The first fatal status, else the first recoverable one, else OK.
grainlaw_status first_failure(std::span<const grainlaw_status> status) {
  const auto fatal = std::ranges::find_if(status, [](auto s) { return s < 0; });
  if (fatal != status.end()) return *fatal;
  const auto recoverable = std::ranges::find_if(status, [](auto s) { return s > 0; });
  return recoverable != status.end() ? *recoverable : GRAINLAW_OK;
}

}  // namespace

grainlaw_report grainlaw_report_default(void) {
  grainlaw_report report{};
  report.size = sizeof report;
  return report;
}

grainlaw_status grainlaw_evaluate(grainlaw_state* handle, const double* F, unsigned want, double* P,
                                  double* A, grainlaw_report* report) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (F == nullptr) return GRAINLAW_NULL_POINTER;
  if (report != nullptr && !api::known_report_size(api::claimed_size(report)))
    return GRAINLAW_BAD_REPORT;
  if (!api::known_want(want)) return GRAINLAW_BAD_ARGUMENT;
  return api::evaluate_point(*handle, F, want, P, A, report);
}

grainlaw_status grainlaw_evaluate_batch(std::size_t n, grainlaw_state* const* states,
                                        const double* F, unsigned want, double* P, double* A,
                                        grainlaw_status* status, grainlaw_report* reports,
                                        int threads) {
  if (n == 0) return GRAINLAW_OK;
  if (states == nullptr || F == nullptr || status == nullptr) return GRAINLAW_NULL_POINTER;
  const api::CancellationOff cancellation;
  std::vector<std::size_t> order;
  const grainlaw_status checked = api::guarded([&] {
    if (const auto found = check_states({states, n}); found != GRAINLAW_OK) return found;
    if (const auto found = check_reports(reports, n); found != GRAINLAW_OK) return found;
    if (!api::known_want(want)) return GRAINLAW_BAD_ARGUMENT;
    order = by_cost({states, n});
    return GRAINLAW_OK;
  });
  if (checked != GRAINLAW_OK) {
    std::fill_n(status, n, checked);
    return checked;
  }

  const auto dimension = static_cast<std::size_t>(states[0]->state.material().packing.dimension);
  const std::size_t square = dimension * dimension;
  const std::size_t stride = reports == nullptr ? 0 : report_stride(reports);
  std::atomic<std::size_t> turn{0};
  const auto evaluate_some = [&] {
    for (std::size_t next = turn++; next < n; next = turn++) {
      const std::size_t k = order[next];
      status[k] = api::evaluate_point(
          *states[k], F + k * square, want, P == nullptr ? nullptr : P + k * square,
          A == nullptr ? nullptr : A + k * square * square, report_at(reports, stride, k));
    }
  };
  if (threads <= 0) threads = api::default_threads();
  const std::size_t most = std::min<std::size_t>(n, api::most_threads);
  const std::size_t together = std::min(static_cast<std::size_t>(threads), most);
  api::work_together(std::ref(evaluate_some), static_cast<int>(together) - 1);
  return first_failure({status, n});
}

grainlaw_status grainlaw_commit(grainlaw_state* handle) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { return handle->state.commit() ? GRAINLAW_OK : GRAINLAW_NO_TRIAL; });
}

grainlaw_status grainlaw_revert(grainlaw_state* handle) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { handle->state.revert(); });
}
