// An equilibrium of the representative volume: all that the next increment needs to know.
#pragma once

#include "contact/history.hpp"

#include <array>
#include <vector>

namespace grainlaw {

struct Configuration {
  std::array<double, 9> deformation{};   // F, dim x dim row-major
  std::vector<double> coordinates;       // component-major positions, then rotations when free
  std::vector<ContactHistory> contacts;  // touching contacts, ordered by (i, j, shift)
  std::array<double, 9> stress{};        // first Piola-Kirchhoff stress P [Pa], dim x dim row-major
  double dissipated = 0;                 // by friction and broken bonds since F = I [J]
  std::vector<double> moments;    // on j, one per contact; empty for laws without moments [N m]
  std::vector<double> bond_gaps;  // stress-free branch - (R_i + R_j), one per contact; empty unless
                                  // bonds span gaps [m]
  double broken_bonds = 0;        // since F = I, each with its contact's weight [-]
};

}  // namespace grainlaw
