// Enthalpy of a packing, whose minimum has the wanted stress, expanded at a state.
#pragma once

#include "math/tensor.hpp"

#include <Eigen/Core>

namespace grainlaw::core {

// Wanted Cauchy stress sigma = -p (1 + deviator). The deviator is [q, r; r, -q] for discs,
// symmetric and traceless for spheres.
template <int D>
struct StressTarget {
  static constexpr std::size_t deviators = D == 2 ? 2 : 6;

  double pressure = 0;  // p [Pa]; unused when volume > 0
  double volume = 0;    // det F instead of the pressure, 0: none [-]
  // Components q, r; or 11, 22, 33, 23, 13, 12 [-].
  std::array<double, deviators> deviator{};
  bool free_shear = true;  // off-diagonal F stays, shear stresses are free
};

// Wanted Cauchy stress at this pressure [Pa].
template <int D>
Tensor<D> target_stress(const StressTarget<D>& target, double pressure);

// Enthalpy, W - (work of the wanted Cauchy stress), as a function of the upper triangle of F. Its
// basis is the volume, then the shapes: diagonal ones, then off-diagonal components.
template <int D>
struct StressDescent {
  static constexpr int components = D * (D + 1) / 2;
  static constexpr int shapes = components - 1;
  using Vector = Eigen::Matrix<double, components, 1>;
  using Matrix = Eigen::Matrix<double, components, components>;

  Matrix basis;     // columns: upper triangle of F by rows, for volume and shapes
  Vector gradient;  // [Pa]
  Matrix slope;     // [Pa]

  // Newton's step towards the minimum, or with its volume towards the wanted one. Stiff packings
  // are often unstable in shear, where the step would lead to a saddle: negative stiffness is
  // replaced by its absolute value.
  [[nodiscard]] Vector step(double most_volume, double most_shape, const double* volume) const;
  // F after a step.
  [[nodiscard]] Tensor<D> moved(Tensor<D> deformation, const Vector& step) const;
};

// cof F|: change of volume per step along the first basis vector.
template <int D>
double length_of_volume(const Tensor<D>& deformation) {
  const auto& f = deformation;
  if constexpr (D == 2) {
    return std::hypot(f[0], f[3]);
  } else {
    return std::hypot(f[4] * f[8], f[0] * f[8], f[0] * f[4]);
  }
}

// Expansion at an upper triangular F, from P and dP/dF there.
template <int D>
StressDescent<D> descent_of(const StressTarget<D>& target, double pressure, const Tensor<D>& f,
                            const Tensor<D>& stress, const Tensor4<D>& tangent);

}  // namespace grainlaw::core
