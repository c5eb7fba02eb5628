// A prescribed quantity as a function of time.
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace verification {

// amplitude sin(2 pi (time - start) / period) for so many periods from `start`, zero elsewhere.
struct Sine {
  double amplitude = 0;
  double period = 1;
  double start = 0;
  double periods = 0.5;

  [[nodiscard]] double at(double time) const;
};

// A linear function between two times, set during the run.
struct LinearSegment {
  double start_time = 0, start_value = 0;
  double end_time = 0, end_value = 0;

  [[nodiscard]] double at(double time) const;
};

// Piecewise linear in time, constant outside its points, plus a sine; or a segment that its owner
// sets. Time is 0 to 1 in quasi-static runs, seconds in dynamic ones.
struct Program {
  std::vector<std::array<double, 2>> points;  // (time, value), times increasing, at least one
  Sine sine{};
  std::shared_ptr<const LinearSegment> steered{};  // replaces points and sine

  [[nodiscard]] double at(double time) const;

  // Linear from `start` at time 0 to `end` at `duration`.
  static Program linear(double start, double end, double duration = 1);
};

}  // namespace verification
