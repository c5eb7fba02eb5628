#include "fe/conditions/program.hpp"

namespace verification {

double Program::at(double time) const {
  if (time <= points.front()[0]) return points.front()[1];
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto& [t0, v0] = points[k - 1];
    const auto& [t1, v1] = points[k];
    if (time <= t1) return v0 + (time - t0) / (t1 - t0) * (v1 - v0);
  }
  return points.back()[1];
}

Program Program::linear(double start, double end, double duration) {
  return {{{0, start}, {duration, end}}};
}

}  // namespace verification
