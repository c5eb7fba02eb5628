// The enthalpy at whose minimum a packing has the wanted stress, seen from where it stands.
#pragma once

#include "math/tensor.hpp"

#include <Eigen/Core>

namespace grainlaw::core {

// Cauchy stress sigma = -p (1 + deviator), the deviator of discs [q, r; r, -q], of spheres symmetric
// without a trace.
template <int D>
struct StressTarget {
  static constexpr std::size_t deviators = D == 2 ? 2 : 6;

  double pressure = 0;  // p [Pa]; unused when volume > 0
  double volume = 0;    // det F instead of the pressure, 0: none [-]
  // q, r; or the components 11, 22, 33, 23, 13, 12 [-].
  std::array<double, deviators> deviator{};
  bool free_shear = true;  // what F has beside its diagonal stays, whatever the shear stresses
};

// [Pa]
template <int D>
Tensor<D> target_stress(const StressTarget<D>& target, double pressure);

// The enthalpy W - (work of the wanted Cauchy stress) by the upper triangle of F: first its volume,
// then its shapes: diagonal ones, and the components beside the diagonal.
template <int D>
struct StressDescent {
  static constexpr int components = D * (D + 1) / 2;
  static constexpr int shapes = components - 1;
  using Vector = Eigen::Matrix<double, components, 1>;
  using Matrix = Eigen::Matrix<double, components, components>;

  Matrix basis;     // columns: upper triangle of F, row by row, of volume and shapes
  Vector gradient;  // [Pa]
  Matrix slope;     // [Pa]

  // Newton's step towards the minimum, or its volume towards the one wanted. Where the packing is
  // unstable, which stiff ones often are in shear, that would lead to a saddle: negative stiffness is
  // taken by its size.
  [[nodiscard]] Vector step(double most_volume, double most_shape, const double* volume) const;
  // F after it.
  [[nodiscard]] Tensor<D> moved(Tensor<D> deformation, const Vector& step) const;
};

// |cof F|, of a change of volume by its step along the first of the basis.
template <int D>
double length_of_volume(const Tensor<D>& deformation) {
  const auto& f = deformation;
  if constexpr (D == 2) {
    return std::hypot(f[0], f[3]);
  } else {
    return std::hypot(f[4] * f[8], f[0] * f[8], f[0] * f[4]);
  }
}

// At an F of which nothing is below the diagonal, by P and dP/dF there.
template <int D>
StressDescent<D> descent_of(const StressTarget<D>& target, double pressure, const Tensor<D>& f,
                            const Tensor<D>& stress, const Tensor4<D>& tangent);

}  // namespace grainlaw::core
