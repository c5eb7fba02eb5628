// Measures with a formula of their own in space.
#pragma once

#include "math/tensor.hpp"

#include <cmath>
#include <limits>

namespace grainlaw::core {

// Largest / smallest eigenvalue of the fabric - 1 [-].
inline double anisotropy(const Tensor<3>& fabric) {
  const Vec<3> values = principal_values(fabric);
  if (!(values[2] > 0)) return 0;
  return values[0] > 0 ? values[2] / values[0] - 1 : std::numeric_limits<double>::infinity();
}

// sqrt(3/2 Fa : Fa) of Fa = 15/2 dev fabric (Guo & Zhao 2014 for spheres) [-].
inline double fabric_intensity(const Tensor<3>& fabric) {
  const double mean = trace<3>(fabric) / 3;
  double squares = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double deviator = fabric[k] - (k % 4 == 0 ? mean : 0);
    squares += deviator * deviator;
  }
  return 7.5 * std::sqrt(1.5 * squares);
}

}  // namespace grainlaw::core
