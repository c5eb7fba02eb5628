// How a prescribed quantity goes over the time of a run.
#pragma once

#include <array>
#include <vector>

namespace verification {

// Piecewise linear in time, constant before the first and after the last point. Time runs from 0 to
// 1 in quasi-static runs, and in seconds in dynamic ones.
struct Program {
  std::vector<std::array<double, 2>> points;  // (time, value), times increasing, at least one

  [[nodiscard]] double at(double time) const;

  // From `start` at time 0 to `end` at `duration`.
  static Program linear(double start, double end, double duration = 1);
};

}  // namespace verification
