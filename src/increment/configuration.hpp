// An equilibrium of the representative volume: all that the next increment needs to know.
#pragma once

#include "contact/history.hpp"
#include "math/tensor.hpp"

#include <vector>

namespace grainlaw {

template <int D>
struct Configuration {
  Tensor<D> deformation{};                  // F
  std::vector<double> coordinates;          // component-major positions, then rotations when free
  std::vector<ContactHistory<D>> contacts;  // touching contacts, ordered by (i, j, shift)
  Tensor<D> stress{};                       // first Piola-Kirchhoff stress P [Pa]
  double dissipated = 0;                    // by friction and broken bonds since F = I [J]
  std::vector<double> moments;    // on j, `spins` per contact; empty for laws without moments [N m]
  std::vector<double> bond_gaps;  // stress-free branch - (R_i + R_j), one per contact; empty unless
                                  // bonds span gaps [m]
  double broken_bonds = 0;        // since F = I, each with its contact's weight [-]
};

}  // namespace grainlaw
