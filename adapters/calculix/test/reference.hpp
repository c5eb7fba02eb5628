// What CalculiX has to get, from P and dP/dF of the library: S = F^-1 P and the symmetric part of
// dS/dE. Of discs F has four components, and nothing answers out of the plane.
#pragma once

#include <grainlaw/grainlaw.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace grainlaw::test {

struct Reference {
  std::array<double, 6> stress;                    // 11 22 33 12 13 23
  std::array<std::array<double, 6>, 6> stiffness;  // symmetric
  double skew = 0;                                 // what is lost, of the largest entry
};

template <std::size_t d>
std::array<double, d * d> inverse(const std::array<double, d * d>& F) {
  if constexpr (d == 2) {
    const double det = F[0] * F[3] - F[1] * F[2];
    return {F[3] / det, -F[1] / det, -F[2] / det, F[0] / det};
  } else {
    const auto cofactor = [&](std::size_t i, std::size_t J) {
      const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, A = (J + 1) % 3, B = (J + 2) % 3;
      return F[3 * a + A] * F[3 * b + B] - F[3 * a + B] * F[3 * b + A];
    };
    const double det = F[0] * cofactor(0, 0) + F[1] * cofactor(0, 1) + F[2] * cofactor(0, 2);
    std::array<double, 9> inv;
    for (std::size_t k = 0; k < 9; ++k) inv[k] = cofactor(k % 3, k / 3) / det;
    return inv;
  }
}

// Evaluates, and commits when asked.
template <std::size_t square>
Reference reference(grainlaw::State& state, const std::array<double, square>& F, bool commit,
                    unsigned want = GRAINLAW_WANT_TANGENT_EXACT) {
  constexpr std::size_t d = square == 4 ? 2 : 3;
  std::array<double, square> P{};
  std::array<double, square * square> A{};
  if (!state.evaluate(F, P, want, A)) {
    throw std::runtime_error("no equilibrium");
  }
  if (commit) state.commit();
  const std::array<double, square> inv = inverse<d>(F);
  const auto S = [&](std::size_t I, std::size_t J) {
    double sum = 0;
    if (I < d && J < d)
      for (std::size_t i = 0; i < d; ++i) sum += inv[d * I + i] * P[d * i + J];
    return sum;
  };
  // C_IJKL = F^-1_Ii F^-1_Kk (A_iJkL - delta_ik S_LJ)
  const auto C = [&](std::size_t I, std::size_t J, std::size_t K, std::size_t L) {
    double sum = 0;
    if (std::max({I, J, K, L}) >= d) return sum;
    for (std::size_t i = 0; i < d; ++i) {
      for (std::size_t k = 0; k < d; ++k) {
        const double geometric = i == k ? S(L, J) : 0;
        sum += inv[I * d + i] * inv[K * d + k] * (A[((i * d + J) * d + k) * d + L] - geometric);
      }
    }
    return sum;
  };
  constexpr std::size_t first[6]{0, 1, 2, 0, 0, 1}, second[6]{0, 1, 2, 1, 2, 2};
  Reference result{};
  std::array<std::array<double, 6>, 6> full{};
  double largest = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    const std::size_t I = first[a], J = second[a];
    result.stress[a] = (S(I, J) + S(J, I)) / 2;
    for (std::size_t b = 0; b < 6; ++b) {
      const std::size_t K = first[b], L = second[b];
      full[a][b] = (C(I, J, K, L) + C(J, I, K, L) + C(I, J, L, K) + C(J, I, L, K)) / 4;
      largest = std::max(largest, std::abs(full[a][b]));
    }
  }
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = 0; b < 6; ++b) {
      result.stiffness[a][b] = (full[a][b] + full[b][a]) / 2;
      result.skew = std::max(result.skew, std::abs(full[a][b] - full[b][a]) / largest);
    }
  }
  return result;
}

// Relative distance of stress[6] and stiffness[21] of CalculiX.
inline std::array<double, 2> distance(const Reference& expected, const double* stress,
                                      const double* stiffness) {
  double difference = 0, norm = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    difference += (stress[a] - expected.stress[a]) * (stress[a] - expected.stress[a]);
    norm += expected.stress[a] * expected.stress[a];
  }
  const double s = std::sqrt(difference / norm);
  difference = norm = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    for (std::size_t a = 0; a <= b; ++a) {
      const double error = *stiffness++ - expected.stiffness[a][b];
      difference += error * error;
      norm += expected.stiffness[a][b] * expected.stiffness[a][b];
    }
  }
  return {s, std::sqrt(difference / norm)};
}

}  // namespace grainlaw::test
