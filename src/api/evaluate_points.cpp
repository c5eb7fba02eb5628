#include "api/evaluate_points.hpp"

#include "api/evaluate_point.hpp"
#include "api/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

namespace grainlaw::core::api {

namespace {

struct NamedStride {
  const char* name;
  std::size_t stride, least;
  [[nodiscard]] bool fits() const { return stride == 0 || stride >= least; }
};

std::array<NamedStride, 3> named(const Strides& strides, int dimension) {
  const auto square = static_cast<std::size_t>(dimension * dimension);
  return {{{"F_stride", strides.F, square},
           {"P_stride", strides.P, square},
           {"A_stride", strides.A, square * square}}};
}

}  // namespace

grainlaw_status check(const PointArrays& arrays, std::size_t n, int dimension) {
  if (n == 0) return GRAINLAW_OK;
  if (arrays.F == nullptr) return GRAINLAW_NULL_POINTER;
  if (const auto found = arrays.reports.check(n); found != GRAINLAW_OK) return found;
  const auto strides = named(arrays.strides, dimension);
  const bool fit = std::all_of(strides.begin(), strides.end(), std::mem_fn(&NamedStride::fits));
  return fit && known_want(arrays.want) ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
}

std::string fault_of(const PointArrays& arrays, int dimension) {
  if (arrays.F == nullptr) return "F is null";
  for (const NamedStride& one : named(arrays.strides, dimension))
    if (!one.fits())
      return fmt::format("{} is {}, expected 0 or at least {} doubles", one.name, one.stride,
                         one.least);
  return known_want(arrays.want) ? "" : fault_of_want(arrays.want);
}

Summary evaluate_points(PointSpan points, std::span<std::size_t> order, const PointArrays& arrays,
                        int threads) noexcept {
  if (points.empty()) return {};
  const CancellationOff cancellation;
  const auto dimension = static_cast<std::size_t>(points[0]->state.dimension());
  const std::size_t square = dimension * dimension;
  const auto or_else = [](std::size_t stride, std::size_t size) {
    return stride == 0 ? size : stride;
  };
  const Strides strides{or_else(arrays.strides.F, square), or_else(arrays.strides.P, square),
                        or_else(arrays.strides.A, square * square)};
  const auto part = [](double* all, std::size_t at) { return all == nullptr ? nullptr : all + at; };
  const auto evaluate = [&](std::size_t k, grainlaw_report& report) {
    const grainlaw_status status =
        evaluate_point(*points[k], arrays.F + k * strides.F, arrays.want,
                       part(arrays.P, k * strides.P), part(arrays.A, k * strides.A), report);
    if (arrays.status != nullptr) arrays.status[k] = status;
    if (void* const wanted = arrays.reports.at(k); wanted != nullptr) copy_out(report, wanted);
    return status;
  };
  return evaluate_all(points, order, std::ref(evaluate), threads);
}

}  // namespace grainlaw::core::api
