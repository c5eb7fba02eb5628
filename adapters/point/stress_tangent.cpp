#include "stress_tangent.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace grainlaw::adapters {
namespace {

constexpr double plane_strain_tolerance = 1e-9;

constexpr std::size_t at(std::size_t i, std::size_t J) { return 3 * i + J; }
constexpr std::size_t at(std::size_t i, std::size_t J, std::size_t k, std::size_t L) {
  return 9 * at(i, J) + at(k, L);
}

double determinant(const Tensor2& F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

Tensor2 inverse(const Tensor2& F) {
  const double J = determinant(F);
  return {(F[4] * F[8] - F[5] * F[7]) / J, (F[2] * F[7] - F[1] * F[8]) / J,
          (F[1] * F[5] - F[2] * F[4]) / J, (F[5] * F[6] - F[3] * F[8]) / J,
          (F[0] * F[8] - F[2] * F[6]) / J, (F[2] * F[3] - F[0] * F[5]) / J,
          (F[3] * F[7] - F[4] * F[6]) / J, (F[1] * F[6] - F[0] * F[7]) / J,
          (F[0] * F[4] - F[1] * F[3]) / J};
}

double norm(std::span<const double> components) {
  double sum = 0;
  for (const double component : components) sum += component * component;
  return std::sqrt(sum);
}

double relative_asymmetry(const Tensor2& tensor) {
  const double most = std::max({std::abs(tensor[1] - tensor[3]), std::abs(tensor[2] - tensor[6]),
                                std::abs(tensor[5] - tensor[7])});
  return most == 0 ? 0 : most / norm(tensor);
}

void symmetrise(Tensor2& tensor) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      tensor[at(i, j)] = tensor[at(j, i)] = (tensor[at(i, j)] + tensor[at(j, i)]) / 2;
    }
  }
}

// Average over the exchange of the first two indices.
void symmetrise_rows(Tensor4& tensor) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t c = 0; c < 9; ++c) {
        double& a = tensor[9 * at(i, j) + c];
        double& b = tensor[9 * at(j, i) + c];
        a = b = (a + b) / 2;
      }
    }
  }
}

// d(P F^T)/dF_kL, symmetric in its first two indices.
void kirchhoff_by_F(const Response& r, Tensor4& out) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double* row = &out[9 * at(i, j)];
      for (std::size_t c = 0; c < 9; ++c) {
        row[c] = r.A[9 * at(i, 0) + c] * r.F[at(j, 0)] + r.A[9 * at(i, 1) + c] * r.F[at(j, 1)] +
                 r.A[9 * at(i, 2) + c] * r.F[at(j, 2)];
      }
      for (std::size_t L = 0; L < 3; ++L) row[at(j, L)] += r.P[at(i, L)];
    }
  }
  symmetrise_rows(out);
}

}  // namespace

int reduce(int dimension, const Tensor2& F, double* reduced) {
  const auto dim = static_cast<std::size_t>(dimension);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t J = 0; J < 3; ++J) {
      if (i < dim && J < dim) {
        reduced[i * dim + J] = F[at(i, J)];
      } else if (!(std::abs(F[at(i, J)] - identity[at(i, J)]) <= plane_strain_tolerance)) {
        return static_cast<int>(at(i, J));
      }
    }
  }
  return -1;
}

void complete(int dimension, const double* P, const double* A, Response& r) {
  const auto dim = static_cast<std::size_t>(dimension);
  r.P = {};
  for (std::size_t i = 0; i < dim; ++i) {
    for (std::size_t J = 0; J < dim; ++J) r.P[at(i, J)] = P[i * dim + J];
  }
  const Tensor2 inv = inverse(r.F);
  for (std::size_t I = 0; I < 3; ++I) {
    for (std::size_t J = 0; J < 3; ++J) {
      r.S[at(I, J)] = inv[at(I, 0)] * r.P[at(0, J)] + inv[at(I, 1)] * r.P[at(1, J)] +
                      inv[at(I, 2)] * r.P[at(2, J)];
    }
  }
  r.asymmetry = relative_asymmetry(r.S);
  if (A == nullptr) return;
  r.A = {};
  for (std::size_t i = 0; i < dim; ++i) {
    for (std::size_t J = 0; J < dim; ++J) {
      for (std::size_t k = 0; k < dim; ++k) {
        for (std::size_t L = 0; L < dim; ++L) r.A[at(i, J, k, L)] = *A++;
      }
    }
  }
  for (std::size_t i = dim; i < 3; ++i) {
    for (std::size_t J = 0; J < dim; ++J) {
      for (std::size_t L = 0; L < dim; ++L) r.A[at(i, J, i, L)] = r.S[at(L, J)];
    }
  }
}

// The sum of the moments on the particles over the volume is S12 - S21. Let each be at most u R f, with f
// the mean contact force: the sum is at most u |S| from two contacts a particle on.
bool is_symmetric(const Response& r, const grainlaw_report& report) {
  if (r.asymmetry <= std::max({1e-6, 10 * report.residual, report.unbalanced})) return true;
  const double stiffness = std::max(1e-12, 1e-3 * report.residual) * norm(r.A);
  return r.asymmetry * norm(r.P) <= stiffness;  // P, since what was averaged away counts
}

Tensor2 second_piola_stress(const Response& r) {
  Tensor2 stress = r.S;
  symmetrise(stress);
  return stress;
}

Tensor2 cauchy_stress(const Response& r) {
  const double J = determinant(r.F);
  Tensor2 stress;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      stress[at(i, j)] = (r.P[at(i, 0)] * r.F[at(j, 0)] + r.P[at(i, 1)] * r.F[at(j, 1)] +
                          r.P[at(i, 2)] * r.F[at(j, 2)]) /
                         J;
    }
  }
  symmetrise(stress);
  return stress;
}

void cauchy_by_F(const Response& r, Tensor4& out) {
  kirchhoff_by_F(r, out);
  const double J = determinant(r.F);
  const Tensor2 inv = inverse(r.F);
  const Tensor2 stress = cauchy_stress(r);
  for (std::size_t ij = 0; ij < 9; ++ij) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t L = 0; L < 3; ++L) {
        double& entry = out[9 * ij + at(k, L)];
        entry = entry / J - stress[ij] * inv[at(L, k)];
      }
    }
  }
}

void second_piola_by_green(const Response& r, Tensor4& out) {
  const Tensor2 inv = inverse(r.F);
  Tensor4 material = r.A;  // dP_iJ/dF_kL less the part of F in P = F S
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t J = 0; J < 3; ++J) {
      for (std::size_t L = 0; L < 3; ++L) material[at(i, J, i, L)] -= r.S[at(L, J)];
    }
  }
  Tensor4 pulled;  // first index pulled back
  for (std::size_t M = 0; M < 3; ++M) {
    for (std::size_t c = 0; c < 27; ++c) {
      pulled[27 * M + c] = inv[at(M, 0)] * material[c] + inv[at(M, 1)] * material[27 + c] +
                           inv[at(M, 2)] * material[54 + c];
    }
  }
  for (std::size_t MJ = 0; MJ < 9; ++MJ) {
    const double* row = &pulled[9 * MJ];
    for (std::size_t N = 0; N < 3; ++N) {
      for (std::size_t L = 0; L < 3; ++L) {
        out[9 * MJ + at(N, L)] = inv[at(N, 0)] * row[at(0, L)] + inv[at(N, 1)] * row[at(1, L)] +
                                 inv[at(N, 2)] * row[at(2, L)];
      }
    }
    for (std::size_t N = 0; N < 3; ++N) {
      for (std::size_t L = 0; L < N; ++L) {
        double& a = out[9 * MJ + at(N, L)];
        double& b = out[9 * MJ + at(L, N)];
        a = b = (a + b) / 2;
      }
    }
  }
  symmetrise_rows(out);
}

void kirchhoff_by_increment(const Response& r, const Tensor2& F0, Tensor4& out) {
  Tensor4 by_F;
  kirchhoff_by_F(r, by_F);
  for (std::size_t ij = 0; ij < 9; ++ij) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double* row = &by_F[9 * ij + 3 * k];
      for (std::size_t m = 0; m < 3; ++m) {
        out[9 * ij + at(k, m)] =
            row[0] * F0[at(m, 0)] + row[1] * F0[at(m, 1)] + row[2] * F0[at(m, 2)];
      }
    }
  }
}

// Without spin the rate of the Kirchhoff stress is its Jaumann rate.
void jaumann_rate(const Response& r, Tensor4& out) {
  kirchhoff_by_increment(r, r.F, out);
  const double J = determinant(r.F);
  for (std::size_t ij = 0; ij < 9; ++ij) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l <= k; ++l) {
        double& a = out[9 * ij + at(k, l)];
        double& b = out[9 * ij + at(l, k)];
        a = b = (a + b) / (2 * J);
      }
    }
  }
}

}  // namespace grainlaw::adapters
