// Stress measures and their tangents, out of what the packing answers: P and dP/dF. Everything is
// three-dimensional here; a packing of discs enters as plane strain.
#pragma once

#include <grainlaw/grainlaw.h>

#include <array>
#include <cstddef>

namespace grainlaw::adapters {

using Tensor2 = std::array<double, 9>;   // [3 i + J]
using Tensor4 = std::array<double, 81>;  // [9 (3 i + J) + 3 k + L]

inline constexpr Tensor2 identity{1, 0, 0, 0, 1, 0, 0, 0, 1};

struct Response {
  Tensor2 F = identity;  // deformation gradient [-]
  Tensor2 P{};           // first Piola-Kirchhoff stress [Pa], tension positive
  Tensor2 S{};           // F^-1 P [Pa]
  Tensor4 A{};           // dP/dF [Pa]
  double asymmetry = 0;  // of S: largest |S_IJ - S_JI| / |S|, 0 where S is 0 [-]
};

// The components of F that a packing of this dimension is asked for: F[dim*dim], row-major.
// Returns the index 3 i + J of a component in which F leaves plane strain, or -1: a packing of
// discs (dimension 2) wants F33 = 1 and F13, F23, F31, F32 = 0, each to 1e-9.
int reduce(int dimension, const Tensor2& F, double* reduced);

// Completes P[dim*dim] and A[dim^4] (or NULL) of the packing to three dimensions. Out of the plane of
// discs S is zero and does not depend on the strain. P = F S then turns with F, and
// dP_3J/dF_3L = S_LJ is all that the tangent has there.
void complete(int dimension, const double* P, const double* A, Response& response);

// Whether F^-1 P is symmetric up to what is out of balance on the particles by the report, drag and
// residual: of the stress, or, where forces all but cancel in it, of the stiffness A.
bool is_symmetric(const Response&, const grainlaw_report&);

// The symmetric part of the second Piola-Kirchhoff stress, and of Cauchy stress [Pa]; the tangents below
// are their derivatives.
Tensor2 second_piola_stress(const Response&);
Tensor2 cauchy_stress(const Response&);

// d(Cauchy stress)/dF [Pa].
void cauchy_by_F(const Response&, Tensor4& out);

// dS/dE, E = (F^T F - I)/2 [Pa]; E12 and E21 count as one variable each, so that both minor
// symmetries hold. Major symmetry does not, once contacts slide.
void second_piola_by_green(const Response&, Tensor4& out);

// d(Kirchhoff stress)/d(dF) [Pa], where F = dF F0.
void kirchhoff_by_increment(const Response&, const Tensor2& F0, Tensor4& out);

// Tangent of Abaqus: Jaumann rate of the Kirchhoff stress over the rate of deformation, over det F [Pa];
// symmetric in its first and in its last two indices.
void jaumann_rate(const Response&, Tensor4& out);

}  // namespace grainlaw::adapters
