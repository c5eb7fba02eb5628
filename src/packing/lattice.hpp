// A lattice of a periodic cell and its change of basis.
#pragma once

#include <array>
#include <cstdint>

namespace grainlaw::core {

using Lattice = std::array<double, 4>;  // H, 2x2 row-major: columns are the lattice vectors [m]

// Another basis of one lattice: H' = H change, so that shift' = change^-1 shift.
struct Basis {
  Lattice cell{};
  std::array<std::int64_t, 4> change{1, 0, 0, 1};  // det 1

  [[nodiscard]] std::array<std::int64_t, 2> shift(std::int64_t s0, std::int64_t s1) const {
    return {change[3] * s0 - change[1] * s1, change[0] * s1 - change[2] * s0};
  }
};

// The shortest basis of the lattice (Lagrange and Gauss), ordered and signed so that det > 0.
// `cell` has a finite det > 0.
Basis reduced_basis(const Lattice& cell);

// Length of the longest lattice vector [m].
double longest_vector(const Lattice& cell);

}  // namespace grainlaw::core
