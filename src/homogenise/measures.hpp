// What a configuration can tell: stress, void ratio, coordination, fabric, energies.
#pragma once

#include "increment/configuration.hpp"
#include "increment/problem.hpp"

#include <grainlaw/grainlaw.h>

#include <array>
#include <vector>

namespace grainlaw {

// One touching contact as it stands, for measures and output.
struct ContactView {
  int i, j;
  std::array<int, 2> shift;
  double branch_x, branch_y;  // x_j - x_i + F H0 shift [m]
  double overlap;             // [m]
  double normal_force;        // negative in the tension of a bond [N]
  double tangential_force;    // on j, along the normal turned by +90 degrees [N]
  double weight;              // 1, or 1 / copies on a frame [-]
  bool bonded;
  double moment;    // of rolling or bending, on j [N m]
  double bond_gap;  // stress-free branch of a bond - (R_i + R_j) [m]
};
std::vector<ContactView> contact_views(const Problem& problem, const Configuration& at);

// Number of components of a measure; -1 when unknown.
int measure_count(const Problem& problem, grainlaw_measure what);

// Fills value[measure_count]. Definitions in grainlaw.h.
void measure(const Problem& problem, const Configuration& at, grainlaw_measure what, double* value);

}  // namespace grainlaw
