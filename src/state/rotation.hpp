// The rotation of an increment and what it does to stress and tangent. A rotation changes nothing
// in the packing, so an increment is solved without it: dF = R U, F* = U F_n, P(F) = R P*(F*).
#pragma once

#include <array>

namespace grainlaw {

struct Increment2 {
  double angle = 0;                  // of R [rad]
  std::array<double, 4> rotation{};  // R
  std::array<double, 4> stretch{};   // U
  std::array<double, 4> target{};    // F* = U F_n
};

// Polar decomposition of F F_n^-1 in two dimensions; both row-major, det > 0.
Increment2 split_rotation(const double* F, const double* committed);

// The same without a rotation, for boundary conditions bound to axes: U = F F_n^-1.
Increment2 without_rotation(const double* F, const double* committed);

std::array<double, 4> rotate_stress(const Increment2& increment, const std::array<double, 4>& p);

// dP/dF from dP*/dF* (both A[((i*2+J)*2+k)*2+L]) with the derivatives of R and U.
std::array<double, 16> rotate_tangent(const Increment2& increment, const double* committed,
                                      const std::array<double, 4>& p,
                                      const std::array<double, 16>& tangent);

}  // namespace grainlaw
