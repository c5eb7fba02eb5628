// Conversion of spheres between coordinates and the records that loops over contacts read.
#pragma once

#include "contact/law.hpp"
#include "contact/records.hpp"
#include "math/tensor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace grainlaw::core {

// Loads component-major coordinates: positions and, if `rotating`, Gibbs vectors of rotations.
inline void load_records(const double* coordinates, bool rotating,
                         std::span<ParticleRecord<3>> records) {
  const std::size_t n = records.size();
  for (std::size_t p = 0; p < n; ++p) {
    auto& record = records[p];
    for (std::size_t k = 0; k < 3; ++k) component(record, k) = coordinates[k * n + p];
    if (!rotating) continue;
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double theta = coordinates[(3 + k) * n + p];
      component(record, 3 + k) = record.radius * theta;
      squares += theta * theta;
    }
    record.half = 0.5 / std::sqrt(1 + 0.25 * squares);
  }
}

inline void store_records(std::span<const ParticleRecord<3>> records, bool rotating,
                          double* coordinates) {
  const std::size_t n = records.size();
  for (std::size_t p = 0; p < n; ++p) {
    const auto& record = records[p];
    for (std::size_t k = 0; k < 3; ++k) coordinates[k * n + p] = component(record, k);
    if (!rotating) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      coordinates[(3 + k) * n + p] = component(record, 3 + k) / record.radius;
    }
  }
}

// Writes forces and moments of nodes, component-major [N, N m].
inline void put_residual(const ForceRecord<3>* forces, std::span<const double> radius,
                         bool rotating, double* residual) {
  const std::size_t m = radius.size();
  for (std::size_t q = 0; q < m; ++q) {
    for (std::size_t k = 0; k < 3; ++k) residual[k * m + q] = component(forces[q], k);
    for (std::size_t k = 0; k < 3; ++k) {
      residual[(3 + k) * m + q] = rotating ? component(forces[q], 3 + k) * radius[q] : 0;
    }
  }
}

template <int D>
LeastMass<D> least_mass(const ContactLaw& law, double r);

template <>
inline LeastMass<3> least_mass<3>(const ContactLaw& law, double r) {
  const double kn = law.stiffness(r, r);
  double spin = law.rotating() ? 2 * law.ratio * kn : 1;
  if (law.moments()) {
    const double rotational = std::max(law.rolling_ratio(r, r), law.twisting_ratio(r, r));
    spin += law.ratio * kn * rotational / (r * r);
  }
  return {kn, spin, 1 / r};
}

inline MassRecord<3> mass_of(const StiffnessRecord<3>& sum, const LeastMass<3>& least,
                             double factor) {
  const double mass = factor * std::max(sum.x, least.x);
  const double spin = factor * std::max(sum.spin_x * least.inverse_radius, least.spin);
  return {mass, mass, mass, spin, spin, spin, {1, 1}};
}

// Writes masses component-major; that of a rotation is I, in the dimension of a stiffness times
// length squared [N m].
inline void put_masses(const MassRecord<3>* records, std::span<const double> radius,
                       bool /*rotating*/, double* mass) {
  const std::size_t m = radius.size();
  for (std::size_t q = 0; q < m; ++q) {
    for (std::size_t k = 0; k < 3; ++k) {
      mass[k * m + q] = records[q].x;
      mass[(3 + k) * m + q] = records[q].spin_x * radius[q] * radius[q];
    }
  }
}

}  // namespace grainlaw::core
