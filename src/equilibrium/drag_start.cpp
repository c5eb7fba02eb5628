#include "equilibrium/drag_start.hpp"

#include "base/constants.hpp"
#include "equilibrium/stages.hpp"
#include "math/inner_product.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

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

// Strain of an increment and the mean strain rate before it.
template <int D>
struct Straining {
  Tensor<D> strain, mean;
  double size = 0;      // of the strain
  double duration = 0;  // [memories]
  Tensor<D> log_duration_by_strain{};
};

// The increment of a request in so many parts. Parts of large strain are slower than the others, so
// that drag is left where strain localises.
template <int D>
Straining<D> straining_of(const Request<D>& request, int parts, double number) {
  Straining<D> at;
  at.strain = symmetric<D>(product<D>(request.deformation, inverse<D>(request.from->deformation)));
  for (std::size_t k = 0; k < D; ++k) at.strain[(D + 1) * k] -= 1;
  at.mean = request.from->strain_rate;
  at.size = std::sqrt(0.5 * inner<D>(at.strain, at.strain));
  const bool timed = request.duration != by_strain;
  at.duration = timed ? request.duration : at.size / number;
  if (!(at.size > 0)) return at;
  const double part = at.size / (tuned::large_drag_strain * parts);
  const double bend = std::tanh(part);
  at.duration *= bend / part;
  const double slope = (1 - bend * bend) * part / bend;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    at.log_duration_by_strain[k] =
        (timed ? slope - 1 : slope) * 0.5 * at.strain[k] / (at.size * at.size);
  }
  return at;
}

// Share of its stiffness and rates that drag keeps as the strain rate reverses, and the derivative of
// the share's logarithm by the strain.
template <int D>
struct Reversal {
  double share = 1;
  Tensor<D> log_by_strain{};
};

// `kept`: share at a full reversal. `slowest`: rate below which the mean counts for little
// [1 / memory].
template <int D>
Reversal<D> reversal_of(const Straining<D>& at, double kept, double slowest) {
  Reversal<D> result;
  const double square = inner<D>(at.mean, at.mean) + slowest * slowest;
  if (!(square > 0)) return result;
  const double along = inner<D>(at.strain, at.mean) / at.duration;
  const double reversed = std::clamp(-along / square, 0.0, 1.0);
  result.share = 1 - (1 - kept) * reversed * reversed * (3 - 2 * reversed);
  if (reversed == 0 || reversed == 1) return result;
  const double slope = (1 - kept) * 6 * reversed * (1 - reversed) / (result.share * square);
  for (std::size_t k = 0; k < squared<D>; ++k) {
    result.log_by_strain[k] =
        slope * (at.mean[k] / at.duration - along * at.log_duration_by_strain[k]);
  }
  return result;
}

// Time step x frequency of the stiffer of contacts and bonds, around which inertia is damped: explicit
// steps become unstable.
constexpr double damped_step = 2;
// Shorter steps have the weight of this one: beside a larger one rounding would hide contact forces.
constexpr double shortest_step = 1e-3;

// Steps that no explicit integration could take have a weight above 1/2, which damps what they do not
// resolve. Shorter steps than the shortest go where acceleration is as before.
template <int D>
DragStart<D> start_inertia(const Request<D>& request, Increment<D>& increment) {
  const Problem<D>& problem = *request.problem;
  increment.begin(problem, *request.from, request.from->deformation);
  increment.find_first_drag(true);
  const double radius = 0.5 * increment.motion().mean_branch();
  const Packing& packing = *problem.packing;
  const double frequency = std::sqrt(problem.law->largest_stiffness(radius, radius) /
                                     particle_mass<D>(packing.density, radius, packing.thickness));
  const double ratio = request.duration * frequency / damped_step;
  const double resolved = std::max(request.duration, shortest_step / frequency);
  DragStart<D> how;
  how.theta = 1 - 0.5 / (1 + ratio * ratio * ratio * ratio);
  how.stiffness = 1 / (how.theta * resolved * how.theta * resolved);
  how.follow = request.duration;
  const double share = request.duration / resolved;
  how.spring_share = 1 - share * share / how.theta;
  how.turn = request.turn;
  return how;
}

}  // namespace

template <int D>
DragStart<D> start_drag(const Request<D>& request, int parts, Increment<D>& increment) {
  if (request.problem->inertia) return start_inertia(request, increment);
  increment.begin(*request.problem, *request.from, request.from->deformation);
  const auto& stress = request.from->stress;
  increment.find_first_drag(
      std::any_of(stress.begin(), stress.end(), [](double p) { return p != 0; }));
  const double number = request.options->viscosity.number;
  const Straining<D> at = straining_of(request, parts, number);

  // A packing whose forces fade needs all of its drag.
  const bool fading = may_fade(request, increment);
  const double kept = fading ? 1 : tuned::drag_of_reversal;
  const double floor = fading ? tuned::fading_drag_floor : tuned::drag_floor;
  Reversal<D> reversal;
  if (at.duration > 0 && at.size > 0) {
    reversal = reversal_of<D>(at, kept, tuned::slowest_drag_rate * number);
  }
  DragStart<D> how;
  const double radius = 0.5 * increment.motion().mean_branch();
  how.stiffness = reversal.share * tuned::drag_stiffness<D> *
                  (increment.scale().mean_force() / radius +
                   floor * request.problem->law->of_bonds().stiffness(radius, radius));
  how.duration = std::min(reversal.share * at.duration / parts, tuned::longest_drag);
  const double bend = std::tanh(how.duration / tuned::longest_follow);
  how.follow = tuned::longest_follow * bend;
  how.spring_share = 1 - how.duration;
  how.follow_by_duration = 1 - bend * bend;
  for (std::size_t k = 0; k < how.turn.size(); ++k) how.turn[k] = request.turn[k] / parts;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    how.strain_rate[k] = (at.mean[k] + at.strain[k]) / (1 + at.duration);
  }
  if (!(at.duration > 0) || !(at.size > 0)) return how;

  how.log_stiffness_by_F = by_deformation<D>(request, reversal.log_by_strain);
  if (how.duration == tuned::longest_drag) return how;
  Tensor<D> duration_by_strain = reversal.log_by_strain;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    duration_by_strain[k] += at.log_duration_by_strain[k];
    duration_by_strain[k] *= how.duration;
  }
  how.duration_by_F = by_deformation<D>(request, duration_by_strain);
  return how;
}

template DragStart<2> start_drag(const Request<2>&, int, Increment<2>&);
template DragStart<3> start_drag(const Request<3>&, int, Increment<3>&);

}  // namespace grainlaw::core
