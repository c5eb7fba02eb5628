// Newton's step of the stretches along the axes towards a pressure, or towards equal stresses at a
// volume.
#pragma once

#include "math/tensor.hpp"

namespace grainlaw::core {

struct StretchAim {
  double pressure;    // wanted; with a fixed volume the present mean [Pa]
  bool keeps_volume;  // aim: equal normal stresses at this volume
};

template <int D>
struct StretchStep {
  double misfit;  // error of the stresses, relative to the pressure [-]
  bool stable;    // whether the step descends in enthalpy
  Vec<D> change;
};

// Cofactor det F / stretch: the Cauchy stress times it is P along the axis.
template <int D>
double cofactor(const Vec<D>& stretch, std::size_t axis) {
  if constexpr (D == 2) {
    return stretch[1 - axis];
  } else {
    return stretch[(axis + 1) % 3] * stretch[(axis + 2) % 3];
  }
}

// Step at F = diag(stretch), from P and dP/dF there.
template <int D>
StretchStep<D> step_of(const StretchAim& aim, const Vec<D>& stretch, const Tensor<D>& stress,
                       const Tensor4<D>& tangent);
template <>
StretchStep<2> step_of<2>(const StretchAim& aim, const Vec<2>& stretch, const Tensor<2>& stress,
                          const Tensor4<2>& tangent);
template <>
StretchStep<3> step_of<3>(const StretchAim& aim, const Vec<3>& stretch, const Tensor<3>& stress,
                          const Tensor4<3>& tangent);

}  // namespace grainlaw::core
