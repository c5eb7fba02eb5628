// Evaluation of many points from the caller's arrays, for batches and sets.
#pragma once

#include "api/report.hpp"
#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <span>
#include <string>

namespace grainlaw::core::api {

// Doubles from one point to the next; 0: without gaps.
struct Strides {
  std::size_t F = 0, P = 0, A = 0;
};

// Arrays of grainlaw_points_evaluate_some; all but F may be null.
struct PointArrays {
  const double* F;
  unsigned want;
  double* P;
  double* A;
  grainlaw_status* status;
  Reports reports;
  Strides strides{};
};

// Returns OK, NULL_POINTER, BAD_REPORT or BAD_ARGUMENT, for n points of this dimension.
[[nodiscard]] grainlaw_status check(const PointArrays& arrays, std::size_t n, int dimension);

// What is wrong with arrays that check refuses.
[[nodiscard]] std::string fault_of(const PointArrays& arrays, int dimension);

// Evaluates points of one dimension from checked arrays. `order` is a workspace with one number per
// point.
Summary evaluate_points(PointSpan points, std::span<std::size_t> order, const PointArrays& arrays,
                        int threads) noexcept;

}  // namespace grainlaw::core::api
