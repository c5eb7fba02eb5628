// Radii, volumes and branches of particles.
#pragma once

#include "math/tensor.hpp"
#include "packing/packing.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace grainlaw::core {

inline double mean_radius(std::span<const double> radius) {
  double mean = 0;
  for (const double r : radius) mean += r / static_cast<double>(radius.size());
  return mean;
}

// Area of a disc [m2], volume of a sphere [m3].
template <int D>
double particle_size(double radius) {
  if constexpr (D == 2) {
    return std::numbers::pi * radius * radius;
  } else {
    return 4 * std::numbers::pi / 3 * radius * radius * radius;
  }
}

// Edge of the square or cube of this size [m].
template <int D>
double edge_of(double size) {
  return D == 2 ? std::sqrt(size) : std::cbrt(size);
}

// Volume of a disc through the thickness, or of a sphere [m3].
template <int D>
double particle_volume(double radius, double thickness) {
  if constexpr (D == 2) {
    return std::numbers::pi * radius * radius * thickness;
  } else {
    return particle_size<3>(radius);
  }
}

// Mass of a particle [kg].
template <int D>
double particle_mass(double density, double radius, double thickness) {
  if constexpr (D == 2) {
    return density * std::numbers::pi * radius * radius * thickness;
  } else {
    return density * particle_size<3>(radius);
  }
}

// Moment of inertia of a disc or sphere over its mass and the square of its radius [-].
template <int D>
constexpr double inertia_share = D == 2 ? 0.5 : 0.4;

// Out-of-plane length that turns a force per length into a pressure: the thickness of discs, one
// mean diameter of spheres [m].
template <int D>
double depth(const Packing& packing) {
  return D == 2 ? packing.thickness : 2 * mean_radius(packing.radius);
}

// Branch x_j - x_i + H shift [m], @formula branch. Positions are component-major with stride
// `particles`.
template <int D>
inline Vec<D> branch(const double* position, std::size_t particles, std::size_t i, std::size_t j,
                     const Tensor<D>& cell, const Vec<D>& shift) {
  Vec<D> result{};
  for (std::size_t k = 0; k < D; ++k) {
    const double* x = position + k * particles;
    result[k] = x[j] - x[i];
    for (std::size_t l = 0; l < D; ++l) result[k] += cell[D * k + l] * shift[l];
  }
  return result;
}

template <int D, class Whole>
Vec<D> vec_of(const Whole& numbers) {
  Vec<D> result{};
  for (std::size_t k = 0; k < D; ++k) result[k] = static_cast<double>(numbers[k]);
  return result;
}

// Maps positions x to g x, component-major.
template <int D>
void map_positions(const Tensor<D>& g, std::size_t n, double* x) {
  for (std::size_t p = 0; p < n; ++p) {
    Vec<D> at{};
    for (std::size_t k = 0; k < D; ++k) at[k] = x[k * n + p];
    const Vec<D> to = product<D>(g, at);
    for (std::size_t k = 0; k < D; ++k) x[k * n + p] = to[k];
  }
}

}  // namespace grainlaw::core
