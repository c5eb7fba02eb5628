// Evaluation of many points out of the caller's arrays, shared by a batch and a set.
#pragma once

#include "api/report.hpp"
#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <span>

namespace grainlaw::core::api {

// As in grainlaw_points_evaluate: all but F may be null.
struct PointArrays {
  const double* F;
  unsigned want;
  double* P;
  double* A;
  grainlaw_status* status;
  Reports reports;
};

// OK, NULL_POINTER, BAD_REPORT or BAD_ARGUMENT, for n points.
[[nodiscard]] grainlaw_status check(const PointArrays& arrays, std::size_t n);

// The points are of one dimension, the arrays are checked; order is room for as many numbers.
Summary evaluate_points(PointSpan points, std::span<std::size_t> order, const PointArrays& arrays,
                        int threads) noexcept;

}  // namespace grainlaw::core::api
