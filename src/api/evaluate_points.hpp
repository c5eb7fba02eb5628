// Evaluation of many points from the caller's arrays, for batches and sets.
#pragma once

#include "api/report.hpp"
#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <span>

namespace grainlaw::core::api {

// Arrays of grainlaw_points_evaluate; all but F may be null.
struct PointArrays {
  const double* F;
  unsigned want;
  double* P;
  double* A;
  grainlaw_status* status;
  Reports reports;
};

// Returns OK, NULL_POINTER, BAD_REPORT or BAD_ARGUMENT, for n points.
[[nodiscard]] grainlaw_status check(const PointArrays& arrays, std::size_t n);

// Evaluates points of one dimension from checked arrays. `order` is a workspace with one number per
// point.
Summary evaluate_points(PointSpan points, std::span<std::size_t> order, const PointArrays& arrays,
                        int threads) noexcept;

}  // namespace grainlaw::core::api
