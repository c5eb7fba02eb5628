// An equilibrium of the representative volume: all that the next increment needs to know.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace grainlaw {

// A touching contact and its history. Branch l = x_j - x_i + F H0 shift.
struct ContactHistory {
  std::int32_t i = 0;
  std::int32_t j = 0;
  std::array<std::int16_t, 2> shift{};
  bool sliding = false;         // at the friction limit
  double tangential_force = 0;  // on j, along the branch normal turned by +90 degrees [N]
};

struct Configuration {
  std::array<double, 9> deformation{};  // F, dim x dim row-major
  std::vector<double> coordinates;      // component-major positions, then rotations when free
  std::vector<ContactHistory> contacts; // touching contacts, ordered by (i, j, shift)
  std::array<double, 9> stress{};       // first Piola-Kirchhoff stress P [Pa], dim x dim row-major
  double dissipated = 0;                // by friction since F = I [J]
};

}  // namespace grainlaw
