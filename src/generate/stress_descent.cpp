#include "generate/stress_descent.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace grainlaw::core {

namespace {

// Least stiffness of a Newton step over the largest.
constexpr double least_stiffness = 1e-4;

// matrix^-1 right for a stable matrix; else with its symmetric part and absolute eigenvalues.
Eigen::VectorXd solve_downhill(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (matrix + matrix.transpose()));
  Eigen::VectorXd values = eigen.eigenvalues();
  const double least = least_stiffness * values.cwiseAbs().maxCoeff();
  if (values(0) > least) return matrix.partialPivLu().solve(right);
  values = values.cwiseAbs().cwiseMax(least);
  const Eigen::MatrixXd& vectors = eigen.eigenvectors();
  return vectors * (vectors.transpose() * right).cwiseQuotient(values);
}

// Indices of the upper triangle by rows.
template <int D>
constexpr auto upper_triangle() {
  std::array<std::size_t, static_cast<std::size_t>(StressDescent<D>::components)> index{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = i; j < D; ++j) index[count++] = D * i + j;
  }
  return index;
}

// Gradient and its derivative over the components of the triangle.
struct Plane {
  Eigen::Vector3d gradient;
  Eigen::Matrix3d slope, basis;
};
Plane in_triangle(const Tensor<2>& f, const Tensor<2>& wanted, const Tensor<2>& stress,
                  const Tensor4<2>& a) {
  const double length = length_of_volume<2>(f);
  Plane plane;
  plane.basis << Eigen::Vector3d(f[3], 0, f[0]) / length, Eigen::Vector3d(f[0], 0, -f[3]) / length,
      Eigen::Vector3d::UnitY();
  // P - sigma cof F for F21 = 0, and its derivative.
  const double s11 = wanted[0];
  const double s22 = wanted[3];
  const double s12 = wanted[1];
  plane.gradient << stress[0] - s11 * f[3] + s12 * f[1], stress[1] - s12 * f[0],
      stress[3] - s22 * f[0];
  plane.slope << a[0], a[1] + s12, a[3] - s11, a[4] - s12, a[5], a[7], a[12] - s22, a[13], a[15];
  return plane;
}

struct Space {
  Eigen::Matrix<double, 6, 1> gradient;
  Eigen::Matrix<double, 6, 6> slope, basis;
};
Space in_triangle(const Tensor<3>& f, const Tensor<3>& wanted, const Tensor<3>& stress,
                  const Tensor4<3>& a) {
  constexpr auto index = upper_triangle<3>();
  constexpr std::array<int, 3> diagonal{0, 3, 5};
  constexpr std::array<int, 3> beside{1, 2, 4};
  Space space;
  Eigen::Vector3d volume(f[4] * f[8], f[0] * f[8], f[0] * f[4]);
  volume.normalize();
  const Eigen::Vector3d first = Eigen::Vector3d(volume(1), -volume(0), 0).normalized();
  const Eigen::Vector3d second = volume.cross(first);
  space.basis.setZero();
  for (int k = 0; k < 3; ++k) {
    const auto row = diagonal[static_cast<std::size_t>(k)];
    space.basis.row(row).head<3>() << volume(k), first(k), second(k);
    space.basis(beside[static_cast<std::size_t>(k)], 3 + k) = 1;
  }
  // P - sigma cof F, with cof F = det F F^-T.
  const Tensor<3> g = inverse<3>(f);
  const double det = determinant<3>(f);
  const Tensor<3> cofactors = transpose<3>(g);
  const Tensor<3> pulled = product<3>(wanted, cofactors);  // over det F
  for (int row = 0; row < 6; ++row) {
    const std::size_t m = index[static_cast<std::size_t>(row)];
    space.gradient(row) = stress[m] - det * pulled[m];
    for (int column = 0; column < 6; ++column) {
      const std::size_t n = index[static_cast<std::size_t>(column)];
      const std::size_t i = m / 3, j = m % 3, k = n / 3, l = n % 3;
      // d(det F^-T_ij) = det (F^-1_lk F^-1_ji - F^-1_jk F^-1_li) dF_kl
      const double change = g[3 * l + k] * pulled[3 * i + j] - g[3 * j + k] * pulled[3 * i + l];
      space.slope(row, column) = a[9 * m + n] - det * change;
    }
  }
  return space;
}

}  // namespace

template <>
Tensor<2> target_stress<2>(const StressTarget<2>& target, double p) {
  const auto [q, r] = target.deviator;
  return {-p * (1 + q), -p * r, -p * r, -p * (1 - q)};
}

template <>
Tensor<3> target_stress<3>(const StressTarget<3>& target, double p) {
  const auto& d = target.deviator;
  return {-p * (1 + d[0]), -p * d[5], -p * d[4], -p * d[5],      -p * (1 + d[1]),
          -p * d[3],       -p * d[4], -p * d[3], -p * (1 + d[2])};
}

template <int D>
StressDescent<D> descent_of(const StressTarget<D>& target, double pressure, const Tensor<D>& f,
                            const Tensor<D>& stress, const Tensor4<D>& tangent) {
  const auto found = in_triangle(f, target_stress<D>(target, pressure), stress, tangent);
  StressDescent<D> descent;
  descent.basis = found.basis;
  descent.gradient = descent.basis.transpose() * found.gradient;
  descent.slope = descent.basis.transpose() * found.slope * descent.basis;
  if (!target.free_shear) return descent;
  for (int k = D; k < StressDescent<D>::components; ++k) {
    descent.gradient(k) = 0;
    descent.slope.row(k).setZero();
    descent.slope.col(k).setZero();
    descent.slope(k, k) = descent.slope(0, 0);
  }
  return descent;
}

template <int D>
typename StressDescent<D>::Vector StressDescent<D>::step(double most_volume, double most_shape,
                                                         const double* volume) const {
  Vector result;
  result(0) = volume != nullptr ? *volume : solve_downhill(slope, -gradient)(0);
  result(0) = std::clamp(result(0), -most_volume, most_volume);
  result.tail(shapes) =
      solve_downhill(slope.bottomRightCorner(shapes, shapes),
                     -gradient.tail(shapes) - slope.bottomLeftCorner(shapes, 1) * result(0));
  const double shape = result.tail(shapes).norm();
  if (shape > most_shape) result.tail(shapes) *= most_shape / shape;
  return result;
}

template <int D>
Tensor<D> StressDescent<D>::moved(Tensor<D> deformation, const Vector& step) const {
  constexpr auto index = upper_triangle<D>();
  const Vector change = basis * step;
  for (std::size_t k = 0; k < index.size(); ++k) {
    deformation[index[k]] += change(static_cast<int>(k));
  }
  return deformation;
}

#define GRAINLAW_FOR(D)                                                                  \
  template struct StressDescent<D>;                                                      \
  template StressDescent<D> descent_of(const StressTarget<D>&, double, const Tensor<D>&, \
                                       const Tensor<D>&, const Tensor4<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
