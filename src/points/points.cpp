#include "points/points.hpp"

#include "points/workers.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <numeric>
#include <utility>

namespace grainlaw::core {

namespace {

void sort_by_cost(PointSpan points, std::span<std::size_t> order) {
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const long first = points[a]->cost;
    const long second = points[b]->cost;
    return first != second ? first > second : a < b;
  });
}

// Processor time of this thread [s].
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Cost of a factorisation in relaxation steps, for some hundreds of particles.
constexpr long steps_per_factorisation = 50;

}  // namespace

grainlaw_status IntegrationPoint::evaluate(const double* F, TangentKind kind, double* P, double* A,
                                           grainlaw_report& report) {
  const double start = thread_seconds();
  trial_tangent.kind = TangentKind::none;
  const bool keeps = keeps_tangents && kind != TangentKind::none;
  const auto square = static_cast<std::size_t>(state.dimension() * state.dimension());
  if (keeps) trial_tangent.values.resize(square * square);
  const grainlaw_status status = state.evaluate(F, kind, P, A, report);
  if (keeps && status == GRAINLAW_OK) {
    std::copy_n(A, square * square, trial_tangent.values.begin());
    trial_tangent.kind = kind;
  }
  cost = report.relaxation_steps + steps_per_factorisation * report.factorisations;
  seconds = thread_seconds() - start;
  return status;
}

bool IntegrationPoint::commit() {
  if (!state.commit()) return false;
  std::swap(committed_tangent, trial_tangent);
  trial_tangent.kind = TangentKind::none;
  return true;
}

grainlaw_status IntegrationPoint::answer(TangentKind kind, double* P, double* A,
                                         grainlaw_report& report) const {
  if (kind != TangentKind::none && kind == committed_tangent.kind) {
    std::copy(committed_tangent.values.begin(), committed_tangent.values.end(), A);
  } else if (kind != TangentKind::none) {
    AnyState copy(state);
    copy.revert();
    copy.set_time_step(0);
    const std::vector<double> F = copy.committed_deformation();
    const grainlaw_status status = copy.evaluate(F.data(), kind, nullptr, A, report);
    if (status != GRAINLAW_OK) return status;
  }
  if (P != nullptr) state.committed_stress(P);
  return GRAINLAW_OK;
}

void Summary::add(std::size_t point, grainlaw_status found, const grainlaw_report& report) {
  if (found == GRAINLAW_OK) return;
  const bool fatal = found < 0;
  const bool first =
      failed == 0 || fatal > (status < 0) || (fatal == (status < 0) && point < first_failed);
  ++failed;
  step_ratio = std::min(step_ratio, report.step_ratio);
  if (!first) return;
  status = found;
  first_failed = point;
  std::memcpy(message, report.message, sizeof message);
}

Summary evaluate_all(PointSpan points, std::span<std::size_t> order, const EvaluateOne& evaluate,
                     int threads) noexcept {
  sort_by_cost(points, order);
  Summary summary;
  std::mutex adding;
  std::atomic<std::size_t> taken{0};
  const auto evaluate_some = [&] {
    for (std::size_t next = taken++; next < order.size(); next = taken++) {
      const std::size_t point = order[next];
      grainlaw_report report{};
      const grainlaw_status status = evaluate(point, report);
      if (status == GRAINLAW_OK) continue;
      const std::lock_guard lock(adding);
      summary.add(point, status, report);
    }
  };
  if (threads <= 0) threads = default_threads();
  const std::size_t most = std::min<std::size_t>(points.size(), most_threads);
  const std::size_t together = std::min(static_cast<std::size_t>(threads), most);
  if (together > 0) work_together(std::ref(evaluate_some), static_cast<int>(together) - 1);
  return summary;
}

bool have_trials(PointSpan points) noexcept {
  const auto has_trial = [](const IntegrationPoint* point) { return point->state.has_trial(); };
  return std::all_of(points.begin(), points.end(), has_trial);
}

void commit_all(PointSpan points) noexcept {
  for (IntegrationPoint* point : points) point->commit();
}

void revert_all(PointSpan points) noexcept {
  for (IntegrationPoint* point : points) point->state.revert();
}

double unforeseen(PointSpan points) noexcept {
  double squares = 0;
  for (const IntegrationPoint* point : points) {
    if (point->committed_tangent.kind == TangentKind::none) return -1;
    squares += point->state.unforeseen(point->committed_tangent.values);
  }
  return squares;
}

}  // namespace grainlaw::core
