#include "equilibrium/drag_start.hpp"

#include "base/constants.hpp"
#include "equilibrium/stages.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

template <int D>
double inner(const Tensor<D>& a, const Tensor<D>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < squared<D>; ++k) sum += a[k] * b[k];
  return sum;
}

template <int D>
Tensor<D> symmetric(const Tensor<D>& a) {
  const Tensor<D> b = transpose<D>(a);
  Tensor<D> result;
  for (std::size_t k = 0; k < squared<D>; ++k) result[k] = 0.5 * (a[k] + b[k]);
  return result;
}

// Derivative by F, given that by the strain of the increment; 0 for found components.
template <int D>
Tensor<D> by_deformation(const Request<D>& request, const Tensor<D>& by_strain) {
  const auto& found = request.problem->space->found;
  Tensor<D> result = product<D>(by_strain, transpose<D>(inverse<D>(request.from->deformation)));
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (found[k]) result[k] = 0;
  }
  return result;
}

}  // namespace

template <int D>
DragStart<D> start_drag(const Request<D>& request, int parts, Increment<D>& increment) {
  increment.begin(*request.problem, *request.from, request.from->deformation);
  const auto& stress = request.from->stress;
  increment.find_first_drag(
      std::any_of(stress.begin(), stress.end(), [](double p) { return p != 0; }));
  const Viscosity& viscosity = request.options->viscosity;
  Tensor<D> strain =
      symmetric<D>(product<D>(request.deformation, inverse<D>(request.from->deformation)));
  for (std::size_t k = 0; k < D; ++k) strain[(D + 1) * k] -= 1;
  const double size = std::sqrt(0.5 * inner<D>(strain, strain));
  const bool timed = request.duration != by_strain;
  const double duration = timed ? request.duration : size / viscosity.number;

  DragStart<D> how;
  how.duration = std::min(duration / parts, tuned::longest_drag);
  const double bend = std::tanh(how.duration / tuned::longest_follow);
  how.follow = tuned::longest_follow * bend;
  how.follow_by_duration = 1 - bend * bend;
  for (std::size_t k = 0; k < how.turn.size(); ++k) how.turn[k] = request.turn[k] / parts;
  const Tensor<D>& mean = request.from->strain_rate;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    how.strain_rate[k] = (mean[k] + strain[k]) / (1 + duration);
  }
  const bool fading = may_fade(request, increment);
  const double radius = 0.5 * increment.motion().mean_branch();
  how.stiffness = tuned::drag_stiffness<D> *
                  (increment.scale().mean_force() / radius +
                   tuned::drag_floor * request.problem->law->stiffness(radius, radius));
  if (!(duration > 0) || !(size > 0)) return how;

  if (!timed && how.duration < tuned::longest_drag) {
    Tensor<D> by_strain = strain;
    for (double& value : by_strain) value *= 0.5 / (size * viscosity.number * parts);
    how.duration_by_F = by_deformation<D>(request, by_strain);
  }
  // Strain rate against its mean, -1 at a full reversal.
  const double slowest = tuned::slowest_drag_rate * viscosity.number;
  const double square = inner<D>(mean, mean) + slowest * slowest;
  if (!(square > 0)) return how;
  const double along = inner<D>(strain, mean) / duration;
  const double turned = std::clamp(-along / square, 0.0, 1.0);
  // A packing whose forces fade needs all of its drag.
  const double drop = fading ? 0 : 1 - tuned::drag_of_reversal;
  const double share = 1 - drop * turned * turned * (3 - 2 * turned);
  how.stiffness *= share;
  if (turned == 0 || turned == 1) return how;
  const double slope = drop * 6 * turned * (1 - turned) / (share * square);
  Tensor<D> by_strain;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    by_strain[k] = slope * mean[k] / duration;
    if (!timed) by_strain[k] -= slope * along * 0.5 * strain[k] / (size * size);
  }
  how.log_stiffness_by_F = by_deformation<D>(request, by_strain);
  return how;
}

template DragStart<2> start_drag(const Request<2>&, int, Increment<2>&);
template DragStart<3> start_drag(const Request<3>&, int, Increment<3>&);

}  // namespace grainlaw::core
