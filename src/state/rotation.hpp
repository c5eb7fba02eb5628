// Rotation of an increment, and its effect on stress and tangent, @formula objectivity. An
// increment is solved without its rotation: dF = R U, F* = U F_n, P(F) = R P*(F*).
#pragma once

#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <array>

namespace grainlaw::core {

template <int D>
struct SplitIncrement {
  std::array<double, Dimension<D>::spins> rotation_vector{};  // rotation vector of R [rad]
  Tensor<D> rotation{};                                       // R
  Tensor<D> stretch{};                                        // U
  Tensor<D> target{};                                         // F* = U F_n
};

// Polar decomposition of F F_n^-1; det > 0.
template <int D>
SplitIncrement<D> split_rotation(const Tensor<D>& F, const Tensor<D>& committed);

// The increment of a boundary condition bound to axes, R = I and U = F F_n^-1.
template <int D>
SplitIncrement<D> without_rotation(const Tensor<D>& F, const Tensor<D>& committed) {
  SplitIncrement<D> increment;
  increment.target = F;
  increment.rotation = identity<D>();
  increment.stretch = product<D>(F, inverse<D>(committed));
  return increment;
}

template <int D>
Tensor<D> rotate_stress(const SplitIncrement<D>& increment, const Tensor<D>& p) {
  return product<D>(increment.rotation, p);
}

// dP/dF from dP*/dF* with the derivatives of R and U.
template <int D>
Tensor4<D> rotate_tangent(const SplitIncrement<D>& increment, const Tensor<D>& committed,
                          const Tensor<D>& p, const Tensor4<D>& tangent);

}  // namespace grainlaw::core
