// How far apart stresses and tangents are, discs' and spheres'.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace grainlaw::core::test {

template <std::size_t size>
double norm(const std::array<double, size>& a) {
  double squares = 0;
  for (const double value : a) squares += value * value;
  return std::sqrt(squares);
}

// |a - b| / |b|
template <std::size_t size>
double relative_difference(const std::array<double, size>& a, const std::array<double, size>& b) {
  std::array<double, size> difference = a;
  for (std::size_t k = 0; k < size; ++k) difference[k] -= b[k];
  return norm(difference) / norm(b);
}

}  // namespace grainlaw::core::test
