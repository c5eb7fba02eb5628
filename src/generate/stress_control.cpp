#include "generate/stress_control.hpp"

#include "homogenise/measures.hpp"
#include "homogenise/stress.hpp"
#include "increment/contact_state.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

constexpr double exact_tolerance = 1e-9;  // residual over the mean contact force [-]
constexpr int most_increments = 400;
// Largest change of the pressure in one increment, as a share. A fall beyond largest_fall is a
// rearrangement: the increment is repeated with a shorter step, down to the least one.
constexpr double largest_change = 0.3;
constexpr double largest_fall = 0.7;
// Changes of shape per increment: the first and the least over the elastic strain p t / kn, and the
// largest.
constexpr double first_shear = 0.3;
constexpr double least_shear = 3e-2;
constexpr double largest_shear = 5e-4;
constexpr int most_escapes = 20;
// Overshoot: slope of the enthalpy at the end of a step over that at its start.
constexpr double too_far = 0.5;

}  // namespace

template <int D>
StressControl<D>::StressControl(const Packing& reference, const ContactLaw& law,
                                Configuration<D> at, double force_floor)
    : law_(law),
      space_(make_cell_space<D>(reference)),
      problem_{&reference, &law_, &space_, force_floor, exact_tolerance},
      at_(std::move(at)) {
  if (!accept(at_.deformation, 0)) at_.stress = {};
}

template <int D>
Tensor<D> StressControl<D>::cauchy() const {
  Tensor<D> sigma = product<D>(at_.stress, transpose<D>(at_.deformation));
  const double det = volume();
  for (double& component : sigma) component /= det;
  return sigma;
}

template <int D>
double StressControl<D>::pressure() const {
  return -1.0 / D * trace<D>(cauchy());
}

template <int D>
double StressControl<D>::volume() const {
  return determinant<D>(at_.deformation);
}

template <int D>
bool StressControl<D>::accept(const Tensor<D>& deformation, double least_pressure) {
  Request<D> request{&problem_, &options_, &at_, deformation};
  request.tolerance = exact_tolerance;
  request.sensitivities = true;
  const Outcome outcome = solve(request, workspace_);
  Increment<D>& increment = workspace_.increment;
  if (outcome.status != GRAINLAW_OK || !loaded(increment)) return false;
  const Tensor<D> stress = piola_stress(increment);
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

// Largest residual relative to the target.
template <int D>
double StressControl<D>::misfit(const StressTarget<D>& target) const {
  const Tensor<D> sigma = cauchy();
  const double p = target.volume > 0 ? pressure() : target.pressure;
  const Tensor<D> wanted = target_stress<D>(target, 1);
  double misfit = target.volume > 0 ? std::abs(volume() / target.volume - 1) : 0;
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = i; j < D; ++j) {
      if (i != j && target.free_shear) continue;
      misfit = std::max(misfit, std::abs(sigma[D * i + j] / p - wanted[D * i + j]));
    }
  }
  return misfit;
}

template <int D>
StressDescent<D> StressControl<D>::descent(const StressTarget<D>& target) const {
  const double p = target.volume > 0 ? pressure() : target.pressure;
  return descent_of<D>(target, p, at_.deformation, at_.stress, tangent_);
}

template <int D>
bool StressControl<D>::reach(const StressTarget<D>& target, double tolerance) {
  const Packing& packing = *problem_.packing;
  const double radius = mean_radius(packing.radius);
  const double line_stiffness = law_.stiffness(radius, radius) / depth<D>(packing);
  // Squeezes the packing where no equilibrium is near; one is found further on.
  int escapes = 0;
  const auto escape = [&](int number) {
    if (number >= most_escapes) return false;
    const double strain = pressure() / line_stiffness;
    for (const double factor : {1.0, 3.0, 10.0, 30.0}) {
      Tensor<D> squeezed = at_.deformation;
      for (double& component : squeezed) component *= 1 - factor * strain;
      if (accept(squeezed, 0)) return true;
    }
    return false;
  };
  double most_shape = first_shear * pressure() / line_stiffness;
  double share = 1;
  constexpr int shapes = StressDescent<D>::shapes;
  for (int k = 0; k < most_increments; ++k) {
    const double now = pressure();
    if (!(now > 0)) return false;
    if (misfit(target) < tolerance) return true;
    const double length = length_of_volume<D>(at_.deformation);
    const StressDescent<D> before = descent(target);
    const double most_volume = largest_change * now * length / std::abs(before.slope(0, 0));
    const double volume_step = (target.volume - volume()) / length;
    const auto step = typename StressDescent<D>::Vector(
        share * before.step(most_volume, most_shape, target.volume > 0 ? &volume_step : nullptr));
    const double shape = step.tail(shapes).norm();
    const double aim = target.volume > 0 ? now : std::min(now, target.pressure);
    const double elastic = now / line_stiffness;
    const bool last_resort = share < 1 && shape <= least_shear * elastic;
    if (!accept(before.moved(at_.deformation, step), last_resort ? 0 : (1 - largest_fall) * aim)) {
      if (last_resort && !escape(escapes++)) return false;
      most_shape = last_resort ? first_shear * elastic : 0.25 * shape;
      share *= 0.5;
      continue;
    }
    share = std::min(2 * share, 1.0);
    const double start_slope = before.gradient.tail(shapes).dot(step.tail(shapes));
    const double end_slope = descent(target).gradient.tail(shapes).dot(step.tail(shapes));
    if (end_slope > too_far * std::abs(start_slope)) {
      most_shape = 0.3 * shape;
    } else {
      most_shape = std::min(2 * most_shape, largest_shear);
    }
  }
  return false;
}

template <int D>
Packing packing_of(const Problem<D>& problem, const Configuration<D>& at) {
  Packing packing = *problem.packing;
  const auto cell = product<D>(at.deformation, tensor_of<D>(packing.cell));
  std::copy(cell.begin(), cell.end(), packing.cell.begin());
  std::copy_n(at.coordinates.begin(), packing.position.size(), packing.position.begin());
  packing.contacts.clear();
  for (const auto& view : contact_views(problem, at)) {
    InitialContact& contact = packing.contacts.emplace_back();
    contact.i = view.i;
    contact.j = view.j;
    std::copy(view.shift.begin(), view.shift.end(), contact.shift.begin());
    contact.normal_force = view.normal_force;
    const auto force = view.tangential_force_vector();
    std::copy(force.begin(), force.end(), contact.tangential_force.begin());
    std::copy(view.moment.begin(), view.moment.end(), contact.moment.begin());
  }
  return packing;
}

template class StressControl<2>;
template class StressControl<3>;
template Packing packing_of(const Problem<2>&, const Configuration<2>&);
template Packing packing_of(const Problem<3>&, const Configuration<3>&);

}  // namespace grainlaw::core
