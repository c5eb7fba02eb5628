// How a prescribed quantity goes over the time of a run.
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace verification {

// amplitude sin(2 pi (time - start) / period) from `start` on for so many periods, zero elsewhere.
struct Sine {
  double amplitude = 0;
  double period = 1;
  double start = 0;
  double periods = 0.5;

  [[nodiscard]] double at(double time) const;
};

// A straight way between two times, for what a run decides as it goes.
struct StraightWay {
  double start_time = 0, start_value = 0;
  double end_time = 0, end_value = 0;

  [[nodiscard]] double at(double time) const;
};

// Piecewise linear in time, constant before the first and after the last point, plus a sine; or what
// the owner of a segment makes of it. Time runs from 0 to 1 in quasi-static runs, and in seconds in
// dynamic ones.
struct Program {
  std::vector<std::array<double, 2>> points;  // (time, value), times increasing, at least one
  Sine sine{};
  std::shared_ptr<const StraightWay> steered{};  // instead of the others

  [[nodiscard]] double at(double time) const;

  // From `start` at time 0 to `end` at `duration`.
  static Program linear(double start, double end, double duration = 1);
};

}  // namespace verification
