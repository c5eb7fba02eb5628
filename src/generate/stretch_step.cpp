#include "generate/stretch_step.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

template <>
StretchStep<2> step_of<2>(const StretchAim& aim, const Vec<2>& stretch, const Tensor<2>& p,
                          const Tensor4<2>& tangent) {
  const auto [a, b] = stretch;
  // dP11 and dP22 over the two stretches.
  const double c11 = tangent[0];
  const double c12 = tangent[3];
  const double c21 = tangent[12];
  const double c22 = tangent[15];
  if (aim.keeps_volume) {
    // At fixed area a = s exp(q), b = s exp(-q); the Cauchy stresses P11 / b and P22 / a become
    // equal.
    const double difference = p[0] / b - p[3] / a;
    const double slope = (c11 * a - c12 * b + p[0]) / b - (c21 * a - c22 * b - p[3]) / a;
    const double q = -difference / slope;
    return {
        std::abs(difference) / aim.pressure, slope > 0, {a * std::expm1(q), b * std::expm1(-q)}};
  }
  const double target = aim.pressure;
  const double r1 = p[0] + target * b;
  const double r2 = p[3] + target * a;
  const double k12 = c12 + target;
  const double k21 = c21 + target;
  const double det = c11 * c22 - k12 * k21;
  const bool stable = c11 > 0 && 4 * c11 * c22 > (k12 + k21) * (k12 + k21);
  return {std::max(std::abs(r1) / b, std::abs(r2) / a) / target,
          stable,
          {-(c22 * r1 - k12 * r2) / det, -(c11 * r2 - k21 * r1) / det}};
}

template <>
StretchStep<3> step_of<3>(const StretchAim& aim, const Vec<3>& stretch, const Tensor<3>& p,
                          const Tensor4<3>& tangent) {
  // Gradient of the enthalpy W + pressure det F.
  Eigen::Vector3d gradient, area;
  Eigen::Matrix3d slope;
  StretchStep<3> step{};
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    area(k) = cofactor<3>(stretch, axis);
    gradient(k) = p[4 * axis] + aim.pressure * area(k);
    step.misfit = std::max(step.misfit, std::abs(gradient(k)) / area(k) / aim.pressure);
    for (int l = 0; l < 3; ++l) {
      const auto other = static_cast<std::size_t>(l);
      slope(k, l) = tangent[9 * 4 * axis + 4 * other] +
                    (l == k ? 0.0 : aim.pressure * stretch[3 - axis - other]);
    }
  }
  Eigen::Matrix3d even = 0.5 * (slope + slope.transpose());
  if (!aim.keeps_volume) {
    step.stable = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(even).eigenvalues()(0) > 0;
    const Eigen::Vector3d change = slope.partialPivLu().solve(-gradient);
    std::copy_n(change.data(), 3, step.change.begin());
    return step;
  }
  // Stretches change across `area` alone; the mean pressure takes up the part along it.
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - area * area.transpose() / area.squaredNorm();
  const double stiff = even.cwiseAbs().maxCoeff();
  even = across * even * across + stiff * area * area.transpose() / area.squaredNorm();
  step.stable = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(even).eigenvalues()(0) > 0;
  Eigen::Matrix4d bordered = Eigen::Matrix4d::Zero();
  bordered.topLeftCorner<3, 3>() = slope;
  bordered.topRightCorner<3, 1>() = area * stiff / area.norm();
  bordered.bottomLeftCorner<1, 3>() = area.transpose() * stiff / area.norm();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  right.head<3>() = -gradient;
  const Eigen::Vector4d change = bordered.partialPivLu().solve(right);
  for (std::size_t k = 0; k < 3; ++k) {
    step.change[k] = stretch[k] * std::expm1(change(static_cast<int>(k)) / stretch[k]);
  }
  return step;
}

}  // namespace grainlaw::core
