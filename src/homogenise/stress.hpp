// First Piola-Kirchhoff stress and tangents of a solved increment.
#pragma once

#include "increment/increment.hpp"
#include "tangent/sensitivity.hpp"

namespace grainlaw::core {

// P at V of F = I, tension positive [Pa], row-major, @formula stress with f_c on j, and with
// inertia its kinetic part. At equilibrium it equals @formula boundary-stress of a frame (Liu,
// Bosco & Suiker 2017, eq. 23). In the cell it is Love's formula (Guo & Zhao 2014, eq. 5).
template <int D>
Tensor<D> piola_stress(const Increment<D>& increment);

// dP_iJ/dF_kL along the branch of equilibria, @formula tangent [Pa]. Exact where no contact changes
// status.
template <int D>
Tensor4<D> condensed_tangent(const Increment<D>& increment, const Sensitivity<D>& sensitivity);

template <>
Tensor4<2> condensed_tangent(const Increment<2>& increment, const Sensitivity<2>& sensitivity);
template <>
Tensor4<3> condensed_tangent(const Increment<3>& increment, const Sensitivity<3>& sensitivity);

// Affine estimate of dP/dF, @formula elastic-tangent (Guo & Zhao 2014, eq. 9) [Pa].
template <int D>
Tensor4<D> elastic_tangent(const Increment<D>& increment);

}  // namespace grainlaw::core
