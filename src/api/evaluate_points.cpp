#include "api/evaluate_points.hpp"

#include "api/evaluate_point.hpp"
#include "api/guard.hpp"

namespace grainlaw::core::api {

grainlaw_status check(const PointArrays& arrays, std::size_t n) {
  if (n == 0) return GRAINLAW_OK;
  if (arrays.F == nullptr) return GRAINLAW_NULL_POINTER;
  if (const auto found = arrays.reports.check(n); found != GRAINLAW_OK) return found;
  return known_want(arrays.want) ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
}

Summary evaluate_points(PointSpan points, std::span<std::size_t> order, const PointArrays& arrays,
                        int threads) noexcept {
  if (points.empty()) return {};
  const CancellationOff cancellation;
  const auto dimension = static_cast<std::size_t>(points[0]->state.dimension());
  const std::size_t square = dimension * dimension;
  const auto part = [](double* all, std::size_t at) { return all == nullptr ? nullptr : all + at; };
  const auto evaluate = [&](std::size_t k, grainlaw_report& report) {
    const grainlaw_status status =
        evaluate_point(*points[k], arrays.F + k * square, arrays.want, part(arrays.P, k * square),
                       part(arrays.A, k * square * square), report);
    if (arrays.status != nullptr) arrays.status[k] = status;
    if (void* const wanted = arrays.reports.at(k); wanted != nullptr) copy_out(report, wanted);
    return status;
  };
  return evaluate_all(points, order, std::ref(evaluate), threads);
}

}  // namespace grainlaw::core::api
