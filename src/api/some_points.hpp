// Points of a set that a call names by number.
#pragma once

#include "api/handle.hpp"

#include <cstddef>

namespace grainlaw::core::api {

struct SomePoints {
  bool known = false;     // false: a number outside the set, or one that comes twice
  std::size_t asked = 0;  // numbers in the call
  PointSpan points;       // in the order of the call, empty unless known
  const std::size_t* which = nullptr;

  // Number in the set of the k-th point.
  [[nodiscard]] std::size_t number(std::size_t k) const { return which == nullptr ? k : which[k]; }
};

// Finds n points by number, each at most once; which may be null: 0 to n - 1. Uses the set's
// workspaces; does not allocate.
SomePoints distinct_points(grainlaw_points& set, std::size_t n, const std::size_t* which);

}  // namespace grainlaw::core::api
