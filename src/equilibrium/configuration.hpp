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
  double dissipated = 0;                 // by friction since F = I [J]
};

}  // namespace grainlaw
