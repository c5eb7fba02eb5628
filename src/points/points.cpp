#include "points/points.hpp"

#include "points/workers.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <numeric>

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

}  // namespace

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

bool commit_all(PointSpan points) noexcept {
  const auto has_trial = [](const IntegrationPoint* point) { return point->state.has_trial(); };
  if (!std::all_of(points.begin(), points.end(), has_trial)) return false;
  for (IntegrationPoint* point : points) point->state.commit();
  return true;
}

void revert_all(PointSpan points) noexcept {
  for (IntegrationPoint* point : points) point->state.revert();
}

}  // namespace grainlaw::core
