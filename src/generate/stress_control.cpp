#include "generate/stress_control.hpp"

#include "homogenise/measures.hpp"
#include "homogenise/stress.hpp"
#include "packing/geometry.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

constexpr double exact_tolerance = 1e-9;  // of the equilibria, relative to the mean force [-]
constexpr double target_tolerance = 1e-7;
constexpr int most_increments = 400;
// The pressure changes at most by this share in one increment; falls it further, a rearrangement
// took part, and the increment is tried again shorter, down to where there is no way around it.
constexpr double largest_change = 0.3;
constexpr double largest_fall = 0.7;
// Changes of shape in one increment: of the first and the shortest, over the elastic strain
// p t / kn, and of the longest.
constexpr double first_shear = 0.3;
constexpr double least_shear = 3e-2;
constexpr double largest_shear = 5e-4;
constexpr int most_escapes = 20;
// Overshoot: the slope of the enthalpy at the end of a step, over that at its start.
constexpr double too_far = 0.5;
// Against the stiffest direction, the least stiffness that a step of Newton's counts on.
constexpr double least_stiffness = 1e-4;

// matrix^-1 right where the matrix is stable; else its even part with eigenvalues by their size.
Eigen::VectorXd solve_downhill(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (matrix + matrix.transpose()));
  Eigen::VectorXd values = eigen.eigenvalues();
  const double least = least_stiffness * values.cwiseAbs().maxCoeff();
  if (values(0) > least) return matrix.partialPivLu().solve(right);
  values = values.cwiseAbs().cwiseMax(least);
  const Eigen::MatrixXd& vectors = eigen.eigenvectors();
  return vectors * (vectors.transpose() * right).cwiseQuotient(values);
}

}  // namespace

StressControl::StressControl(const Packing& reference, const ContactLaw& law, Configuration<2> at,
                             double force_floor)
    : law_(law),
      space_(make_cell_space<2>(reference)),
      problem_{&reference, &law_, &space_, force_floor, exact_tolerance},
      at_(std::move(at)) {
  if (!accept(at_.deformation, 0)) at_.stress = {};
}

StressControl::Tensor StressControl::cauchy() const {
  const auto& p = at_.stress;
  const auto& f = at_.deformation;
  const double det = volume();
  return {(p[0] * f[0] + p[1] * f[1]) / det, (p[0] * f[2] + p[1] * f[3]) / det,
          (p[2] * f[0] + p[3] * f[1]) / det, (p[2] * f[2] + p[3] * f[3]) / det};
}

double StressControl::pressure() const {
  const Tensor sigma = cauchy();
  return -0.5 * (sigma[0] + sigma[3]);
}

double StressControl::volume() const { return determinant<2>(at_.deformation); }

bool StressControl::accept(const Tensor& deformation, double least_pressure) {
  Request<2> request{&problem_, &options_, &at_, deformation};
  request.tolerance = exact_tolerance;
  request.sensitivities = true;
  const Outcome outcome = solve(request, workspace_);
  Increment<2>& increment = workspace_.increment;
  if (outcome.status != GRAINLAW_OK || !increment.bears()) return false;
  const Tensor stress = piola_stress(increment);
  const auto tangent = outcome.sensitivities ? condensed_tangent(increment, workspace_.sensitivity)
                                             : elastic_tangent(increment);
  increment.advance_history();
  increment.export_to(at_, next_);
  next_.stress = stress;
  std::swap(at_, next_);
  if (!(pressure() >= least_pressure)) {
    std::swap(at_, next_);
    return false;
  }
  tangent_ = tangent;
  return true;
}

// The largest residual, relative to the target.
double StressControl::misfit(const StressTarget& target) const {
  const Tensor sigma = cauchy();
  const double p = target.volume > 0 ? pressure() : target.pressure;
  const auto [q, r] = target.deviator;
  const double volume_error = target.volume > 0 ? std::abs(volume() / target.volume - 1) : 0;
  return std::max({volume_error, std::abs(sigma[0] / p + 1 + q), std::abs(sigma[3] / p + 1 - q),
                   target.free_shear ? 0 : std::abs(sigma[1] / p + r)});
}

// The enthalpy W - (work of the wanted Cauchy stress), at whose minimum it is the stress, seen from
// where the packing stands: by volume, and by shape (F11 / F22 and F12).
struct StressControl::Descent {
  Eigen::Matrix3d basis;     // columns: F11, F12, F22 of volume and shapes
  Eigen::Vector3d gradient;  // [Pa]
  Eigen::Matrix3d slope;     // [Pa]

  // Newton's step towards the minimum, or its volume towards the one wanted. Where the packing is
  // unstable, which stiff ones often are in shear, that would lead to a saddle: negative stiffness is
  // taken by its size.
  [[nodiscard]] Eigen::Vector3d step(double most_volume, double most_shape,
                                     const double* volume) const {
    Eigen::Vector3d result;
    result(0) = volume != nullptr ? *volume : solve_downhill(slope, -gradient)(0);
    result(0) = std::clamp(result(0), -most_volume, most_volume);
    result.tail(2) = solve_downhill(slope.bottomRightCorner(2, 2),
                                    -gradient.tail(2) - slope.bottomLeftCorner(2, 1) * result(0));
    const double shape = result.tail(2).norm();
    if (shape > most_shape) result.tail(2) *= most_shape / shape;
    return result;
  }
};

StressControl::Descent StressControl::descent(const StressTarget& target) const {
  const auto& f = at_.deformation;
  const auto& a = tangent_;
  const double p = target.volume > 0 ? pressure() : target.pressure;
  const double length = std::hypot(f[0], f[3]);
  Descent descent;
  descent.basis << Eigen::Vector3d(f[3], 0, f[0]) / length,
      Eigen::Vector3d(f[0], 0, -f[3]) / length, Eigen::Vector3d::UnitY();
  // P - sigma cof F for F21 = 0, and its derivative.
  const double s11 = -p * (1 + target.deviator[0]);
  const double s22 = -p * (1 - target.deviator[0]);
  const double s12 = -p * target.deviator[1];
  const auto& stress = at_.stress;
  const Eigen::Vector3d gradient(stress[0] - s11 * f[3] + s12 * f[1], stress[1] - s12 * f[0],
                                 stress[3] - s22 * f[0]);
  Eigen::Matrix3d slope;
  slope << a[0], a[1] + s12, a[3] - s11, a[4] - s12, a[5], a[7], a[12] - s22, a[13], a[15];
  descent.gradient = descent.basis.transpose() * gradient;
  descent.slope = descent.basis.transpose() * slope * descent.basis;
  if (target.free_shear) {
    descent.gradient(2) = 0;
    descent.slope.row(2).setZero();
    descent.slope.col(2).setZero();
    descent.slope(2, 2) = descent.slope(0, 0);
  }
  return descent;
}

bool StressControl::reach(const StressTarget& target) {
  const Packing& packing = *problem_.packing;
  const double radius = mean_radius(packing.radius);
  const double line_stiffness = law_.stiffness(radius, radius) / packing.thickness;
  // Where no equilibrium is near any more, squeezing finds one further on.
  int escapes = 0;
  const auto escape = [&](int number) {
    if (number >= most_escapes) return false;
    const double strain = pressure() / line_stiffness;
    for (const double factor : {1.0, 3.0, 10.0, 30.0}) {
      const auto& f = at_.deformation;
      const double c = 1 - factor * strain;
      if (accept({c * f[0], c * f[1], f[2], c * f[3]}, 0)) return true;
    }
    return false;
  };
  double most_shape = first_shear * pressure() / line_stiffness;
  double share = 1;
  for (int k = 0; k < most_increments; ++k) {
    const double now = pressure();
    if (!(now > 0)) return false;
    if (misfit(target) < target_tolerance) return true;
    const auto& f = at_.deformation;
    const double length = std::hypot(f[0], f[3]);
    const Descent before = descent(target);
    const double most_volume = largest_change * now * length / std::abs(before.slope(0, 0));
    const double volume_step = (target.volume - volume()) / length;
    const Eigen::Vector3d step =
        share * before.step(most_volume, most_shape, target.volume > 0 ? &volume_step : nullptr);
    const double shape = step.tail(2).norm();
    const double aim = target.volume > 0 ? now : std::min(now, target.pressure);
    const double elastic = now / line_stiffness;
    const bool last_resort = share < 1 && shape <= least_shear * elastic;
    const Eigen::Vector3d change = before.basis * step;
    if (!accept({f[0] + change(0), f[1] + change(1), f[2], f[3] + change(2)},
                last_resort ? 0 : (1 - largest_fall) * aim)) {
      if (last_resort && !escape(escapes++)) return false;
      most_shape = last_resort ? first_shear * elastic : 0.25 * shape;
      share *= 0.5;
      continue;
    }
    share = std::min(2 * share, 1.0);
    const double start_slope = before.gradient.tail(2).dot(step.tail(2));
    const double end_slope = descent(target).gradient.tail(2).dot(step.tail(2));
    if (end_slope > too_far * std::abs(start_slope)) {
      most_shape = 0.3 * shape;
    } else {
      most_shape = std::min(2 * most_shape, largest_shear);
    }
  }
  return false;
}

Packing packing_of(const Problem<2>& problem, const Configuration<2>& at) {
  Packing packing = *problem.packing;
  const auto cell = product<2>(at.deformation, tensor_of<2>(packing.cell));
  std::copy(cell.begin(), cell.end(), packing.cell.begin());
  std::copy_n(at.coordinates.begin(), packing.position.size(), packing.position.begin());
  packing.contacts.clear();
  for (const auto& view : contact_views(problem, at)) {
    const auto force = view.tangential_force_vector();
    packing.contacts.push_back(
        {view.i, view.j, {view.shift[0], view.shift[1]}, view.normal_force, {force[0], force[1]}});
    packing.contacts.back().moment = view.moment[0];
  }
  return packing;
}

}  // namespace grainlaw::core
