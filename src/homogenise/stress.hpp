// First Piola-Kirchhoff stress and tangents of a solved increment.
#pragma once

#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

namespace grainlaw::core {

// P = -(1/V) sum_c f_c (x) F^-1 l_c, f_c on j, V at F = I, tension positive [Pa], row-major. At
// equilibrium equal to (1/V) sum_q a_q (x) X_q of a frame (Liu, Bosco & Suiker 2017, eq. 23) and to
// Love's formula for the cell (Guo & Zhao 2014, eq. 5).
template <int D>
Tensor<D> piola_stress(const Increment<D>& increment);

// dP_iJ/dF_kL condensed: the derivative along the branch of equilibria, exact where no contact
// changes status [Pa].
template <int D>
Tensor4<D> condensed_tangent(const Increment<D>& increment, const Sensitivity<D>& sensitivity);

template <>
Tensor4<2> condensed_tangent(const Increment<2>& increment, const Sensitivity<2>& sensitivity);
template <>
Tensor4<3> condensed_tangent(const Increment<3>& increment, const Sensitivity<3>& sensitivity);

// Affine estimate (1/V) sum_c (kn n L n L + kt t L t L), Guo & Zhao (2014) eq. 9 as dP/dF [Pa].
template <int D>
Tensor4<D> elastic_tangent(const Increment<D>& increment);

}  // namespace grainlaw::core
