// What CalculiX has to get, from P and dP/dF of the library: S = F^-1 P and the symmetric part of
// dS/dE, in the plane: 11 22 12.
#pragma once

#include <grainlaw/grainlaw.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace grainlaw::test {

struct Reference {
  std::array<double, 3> stress;
  std::array<std::array<double, 3>, 3> stiffness;  // symmetric
  double skew = 0;                                 // what is lost, of the largest entry
};

// Evaluates, and commits when asked.
inline Reference reference(grainlaw::State& state, const std::array<double, 4>& F, bool commit,
                           unsigned want = GRAINLAW_WANT_TANGENT_EXACT) {
  std::array<double, 4> P{};
  std::array<double, 16> A{};
  if (!state.evaluate(F, P, want, A)) {
    throw std::runtime_error("no equilibrium");
  }
  if (commit) state.commit();
  const double det = F[0] * F[3] - F[1] * F[2];
  const std::array<double, 4> inv{F[3] / det, -F[1] / det, -F[2] / det, F[0] / det};
  const auto S = [&](std::size_t I, std::size_t J) {
    return inv[2 * I] * P[J] + inv[2 * I + 1] * P[2 + J];
  };
  // C_IJKL = F^-1_Ii F^-1_Kk (A_iJkL - delta_ik S_LJ)
  const auto C = [&](std::size_t I, std::size_t J, std::size_t K, std::size_t L) {
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double geometric = i == k ? S(L, J) : 0;
        sum += inv[2 * I + i] * inv[2 * K + k] * (A[((i * 2 + J) * 2 + k) * 2 + L] - geometric);
      }
    }
    return sum;
  };
  constexpr std::size_t first[3]{0, 1, 0}, second[3]{0, 1, 1};
  Reference result{};
  std::array<std::array<double, 3>, 3> full{};
  double largest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t I = first[a], J = second[a];
    result.stress[a] = (S(I, J) + S(J, I)) / 2;
    for (std::size_t b = 0; b < 3; ++b) {
      const std::size_t K = first[b], L = second[b];
      full[a][b] = (C(I, J, K, L) + C(J, I, K, L) + C(I, J, L, K) + C(J, I, L, K)) / 4;
      largest = std::max(largest, std::abs(full[a][b]));
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      result.stiffness[a][b] = (full[a][b] + full[b][a]) / 2;
      result.skew = std::max(result.skew, std::abs(full[a][b] - full[b][a]) / largest);
    }
  }
  return result;
}

// Relative distance of stress[6] and stiffness[21] of CalculiX; what is out of the plane must be 0.
inline std::array<double, 2> distance(const Reference& expected, const double* stress,
                                      const double* stiffness) {
  constexpr std::size_t place[3]{0, 1, 3};  // 11 22 12 among 11 22 33 12 13 23
  const auto stress_of = [&](std::size_t a) -> double {
    return a == 0 || a == 1 ? expected.stress[a] : a == 3 ? expected.stress[2] : 0;
  };
  double difference = 0, norm = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    difference += (stress[a] - stress_of(a)) * (stress[a] - stress_of(a));
    norm += stress_of(a) * stress_of(a);
  }
  const double s = std::sqrt(difference / norm);
  std::array<std::array<double, 6>, 6> full{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) full[place[a]][place[b]] = expected.stiffness[a][b];
  }
  difference = norm = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    for (std::size_t a = 0; a <= b; ++a) {
      const double error = *stiffness++ - full[a][b];
      difference += error * error;
      norm += full[a][b] * full[a][b];
    }
  }
  return {s, std::sqrt(difference / norm)};
}

}  // namespace grainlaw::test
