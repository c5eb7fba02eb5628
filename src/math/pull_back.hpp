// F^-1 of a vector: a branch or a change of it back in the reference configuration.
#pragma once

#include "base/simd.hpp"

#include <array>

namespace grainlaw {

struct PullBack {
  double a, b, c, d;

  // Of F, row-major.
  explicit PullBack(const std::array<double, 4>& f) {
    const double det = f[0] * f[3] - f[1] * f[2];
    a = f[3] / det;
    b = -f[1] / det;
    c = -f[2] / det;
    d = f[0] / det;
  }
  [[nodiscard]] GRAINLAW_INLINE std::array<double, 2> operator()(double x, double y) const {
    return {a * x + b * y, c * x + d * y};
  }
};

}  // namespace grainlaw
