// Conversion of discs between coordinates and the records that loops over contacts read.
#pragma once

#include "contact/law.hpp"
#include "contact/records.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace grainlaw::core {

// Loads component-major coordinates: x, y and, if `rotating`, rotations.
inline void load_records(const double* coordinates, bool rotating,
                         std::span<ParticleRecord<2>> records) {
  const std::size_t n = records.size();
  const double* x = coordinates;
  const double* y = x + n;
  const double* rotation = rotating ? y + n : nullptr;
  for (std::size_t p = 0; p < n; ++p) {
    auto& record = records[p];
    record.x = x[p];
    record.y = y[p];
    if (rotation) record.roll = record.radius * rotation[p];
  }
}

inline void store_records(std::span<const ParticleRecord<2>> records, bool rotating,
                          double* coordinates) {
  const std::size_t n = records.size();
  double* x = coordinates;
  double* y = x + n;
  double* rotation = rotating ? y + n : nullptr;
  for (std::size_t p = 0; p < n; ++p) {
    const auto& record = records[p];
    x[p] = record.x;
    y[p] = record.y;
    if (rotation) rotation[p] = record.roll / record.radius;
  }
}

// Writes forces and moments of nodes, component-major [N, N m].
inline void put_residual(const ForceRecord<2>* forces, std::span<const double> radius,
                         bool rotating, double* residual) {
  const std::size_t m = radius.size();
  for (std::size_t q = 0; q < m; ++q) {
    residual[q] = forces[q].x;
    residual[m + q] = forces[q].y;
  }
  if (!rotating) return;
  for (std::size_t q = 0; q < m; ++q) residual[2 * m + q] = forces[q].roll * radius[q];
}

template <int D>
LeastMass<D> least_mass(const ContactLaw& law, double r);

template <>
inline LeastMass<2> least_mass<2>(const ContactLaw& law, double r) {
  const double kn = law.stiffness(r, r);
  double kt = law.rotating() ? 2 * law.ratio * kn : 1;
  if (law.moments()) kt += law.ratio * kn * law.rolling_ratio(r, r) / (r * r);
  return {kn, kn, kt, 1 / r};
}

inline MassRecord<2> mass_of(const StiffnessRecord<2>& sum, const LeastMass<2>& least,
                             double factor) {
  const double mass = factor * std::max(sum.x, least.x);
  return {mass, mass, factor * std::max(sum.roll * least.inverse_radius, least.roll), 1};
}

// Writes masses component-major; that of a rotation is I, in the dimension of a stiffness times
// length squared [N m].
inline void put_masses(const MassRecord<2>* records, std::span<const double> radius, bool rotating,
                       double* mass) {
  const std::size_t m = radius.size();
  for (std::size_t q = 0; q < m; ++q) {
    const double r = radius[q];
    mass[q] = mass[m + q] = records[q].x;
    if (rotating) mass[2 * m + q] = records[q].roll * r * r;
  }
}

}  // namespace grainlaw::core
