// First Piola-Kirchhoff stress and tangents of a solved increment.
#pragma once

#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

#include <array>

namespace grainlaw {

// P = -(1/V) sum_c f_c (x) F^-1 l_c, f_c on j, V at F = I, tension positive [Pa], row-major. At
// equilibrium equal to (1/V) sum_q a_q (x) X_q of a frame (Liu, Bosco & Suiker 2017, eq. 23) and to
// Love's formula for the cell (Guo & Zhao 2014, eq. 5).
std::array<double, 4> piola_stress(const Increment& increment);

// dP_iJ/dF_kL condensed: the derivative along the branch of equilibria, exact where no contact
// changes status. A[((i*2+J)*2+k)*2+L] [Pa].
std::array<double, 16> condensed_tangent(const Increment& increment,
                                         const Sensitivity& sensitivity);

// Affine estimate (1/V) sum_c (kn n L n L + kt t L t L), Guo & Zhao (2014) eq. 9 as dP/dF [Pa].
std::array<double, 16> elastic_tangent(const Increment& increment);

}  // namespace grainlaw
