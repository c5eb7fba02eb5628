// Measures of a configuration: stress, void ratio, coordination, fabric, energies.
#pragma once

#include "increment/configuration.hpp"
#include "increment/problem.hpp"

#include <grainlaw/grainlaw.h>

#include <array>
#include <vector>

namespace grainlaw::core {

// One touching contact, for measures and output.
template <int D>
struct ContactView {
  int i, j;
  std::array<int, static_cast<std::size_t>(D)> shift;
  Vec<D> branch;        // x_j - x_i + F H0 shift [m]
  double overlap;       // [m]
  double normal_force;  // negative in the tension of a bond [N]
  // Tangential force on j, laid out as in ContactHistory [N].
  std::array<double, Dimension<D>::tangents> tangential_force;
  double weight;  // 1, or 1 / copies on a frame [-]
  bool bonded;
  // Moment of rolling or bending on j [N m].
  std::array<double, Dimension<D>::spins> moment;
  double bond_gap;  // stress-free branch of a bond - (R_i + R_j) [m]

  // Tangential force on j as a vector [N].
  [[nodiscard]] Vec<D> tangential_force_vector() const;
};
template <>
Vec<2> ContactView<2>::tangential_force_vector() const;
template <>
inline Vec<3> ContactView<3>::tangential_force_vector() const {
  return tangential_force;
}

template <int D>
std::vector<ContactView<D>> contact_views(const Problem<D>& problem, const Configuration<D>& at);

// Number of components of a measure; -1 for an unknown one.
int measure_count(int dimension, grainlaw_measure what);

// Computes value[measure_count]; definitions and units in grainlaw.h.
template <int D>
void measure(const Problem<D>& problem, const Configuration<D>& at, grainlaw_measure what,
             double* value);

}  // namespace grainlaw::core
