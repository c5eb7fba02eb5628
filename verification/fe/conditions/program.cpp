#include "fe/conditions/program.hpp"

#include <cmath>
#include <numbers>

namespace verification {
namespace {

double interpolate(const std::vector<std::array<double, 2>>& points, double time) {
  if (time <= points.front()[0]) return points.front()[1];
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto& [t0, v0] = points[k - 1];
    const auto& [t1, v1] = points[k];
    if (time <= t1) return v0 + (time - t0) / (t1 - t0) * (v1 - v0);
  }
  return points.back()[1];
}

}  // namespace

double Sine::at(double time) const {
  const double elapsed = (time - start) / period;
  if (amplitude == 0 || elapsed <= 0 || elapsed >= periods) return 0;
  return amplitude * std::sin(2 * std::numbers::pi * elapsed);
}

double LinearSegment::at(double time) const {
  if (time >= end_time) return end_value;
  if (time <= start_time) return start_value;
  return start_value + (time - start_time) / (end_time - start_time) * (end_value - start_value);
}

double Program::at(double time) const {
  return steered != nullptr ? steered->at(time) : interpolate(points, time) + sine.at(time);
}

Program Program::linear(double start, double end, double duration) {
  return {{{0, start}, {duration, end}}};
}

}  // namespace verification
