#include "state/state.hpp"

#include "base/capacity.hpp"
#include "equilibrium/strategy.hpp"
#include "homogenise/stress.hpp"
#include "increment/contact_state.hpp"
#include "state/report.hpp"
#include "state/rotated_configuration.hpp"
#include "state/scratch.hpp"
#include "state/trial_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

// Largest stretch in one increment; beyond it the committed contacts say nothing of the new ones.
constexpr double largest_stretch_change = 0.3;
// Step of the forward differences of the perturbed tangent: well above the tolerance of the solve,
// well below the increments of a host.
constexpr double perturbation = 1e-5;
constexpr double perturbed_tolerance = 1e-9;

template <int D>
bool too_far(const SplitIncrement<D>& split) {
  const Tensor<D> one = identity<D>();
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (!(std::abs(split.stretch[k] - one[k]) <= largest_stretch_change)) return true;
  }
  return false;
}

template <int D>
SplitIncrement<D> split(const BoundarySpace<D>& space, const Tensor<D>& F,
                        const Tensor<D>& committed) {
  return space.bound_to_axes() ? without_rotation<D>(F, committed)
                               : split_rotation<D>(F, committed);
}

// Sets the guess to the last trial without the rotation of its increment since `from`.
template <int D>
void guess_from_trial(const Configuration<D>& from, const Configuration<D>& trial,
                      std::size_t particles, Workspace<D>& w, Request<D>& request) {
  const auto last = split<D>(*request.problem->space, trial.deformation, from.deformation);
  auto& z = w.guess;
  z = trial.coordinates;
  map_positions<D>(transpose<D>(last.rotation), particles, z.data());
  to_relative_rotation(last, from, particles, z);
  request.guess = &z;
  request.guess_deformation = last.target;
}

// Forward differences of P, each from the same history (Guo & Zhao 2014, eq. 8, as dP/dF).
template <int D>
grainlaw_status perturb(Request<D> request, Workspace<D>& w, Tensor4<D>& tangent,
                        grainlaw_report& report) {
  const auto centre = request.deformation;
  request.tolerance = std::min(request.tolerance, perturbed_tolerance);
  request.loose_tolerance = 0;  // differences need the tight tolerance
  request.sensitivities = false;
  request.guess = nullptr;
  const auto stress_at = [&](std::size_t component, double step, Tensor<D>& p) {
    request.deformation = centre;
    request.deformation[component] += step;
    const auto outcome = solve(request, w);
    add_cost(w.increment, report);
    p = loaded(w.increment) ? piola_stress(w.increment) : Tensor<D>{};
    return outcome.status;
  };
  Tensor<D> p0{};
  if (const auto status = stress_at(0, 0, p0); status != GRAINLAW_OK) return status;
  const auto& found = request.problem->space->found;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (found[k]) continue;
    Tensor<D> p{};
    if (const auto status = stress_at(k, perturbation, p); status != GRAINLAW_OK) return status;
    for (std::size_t m = 0; m < squared<D>; ++m) {
      if (!found[m]) tangent[m * squared<D> + k] = (p[m] - p0[m]) / perturbation;
    }
  }
  return GRAINLAW_OK;
}

template <std::size_t size>
double norm(const std::array<double, size>& tangent) {
  double squares = 0;
  for (const double a : tangent) squares += a * a;
  return std::sqrt(squares);
}

// Exact or elastic tangent; zero for other kinds.
template <int D>
Tensor4<D> tangent_of(const Workspace<D>& w, const Outcome& outcome, TangentKind kind,
                      grainlaw_report& report) {
  if (kind != TangentKind::exact && kind != TangentKind::elastic) return {};
  if (kind == TangentKind::exact && outcome.sensitivities && !outcome.loose) {
    report.tangent_exact = outcome.history_advanced || w.sensitivity.arbitrary() ? 0 : 1;
    if (w.sensitivity.arbitrary()) {
      describe(report,
               "a sphere of two contacts rests against one that nothing holds, or two against each "
               "other: where they are has no derivative, and the tangent takes that as fixed");
    }
    return condensed_tangent(w.increment, w.sensitivity);
  }
  const auto elastic = elastic_tangent(w.increment);
  if (kind == TangentKind::elastic) return elastic;
  if (!outcome.loose) {
    describe(report, "the stiffness is singular; the elastic tangent was returned");
    return elastic;
  }
  // Sliding and lost contacts only reduce stiffness. A tangent above the elastic one comes from a
  // nearly singular matrix, which is possible away from equilibrium.
  if (outcome.sensitivities) {
    const auto tangent = condensed_tangent(w.increment, w.sensitivity);
    if (norm(tangent) <= norm(elastic)) {
      describe(report, "ended at solver.loose_tolerance; the tangent is of the contacts there");
      return tangent;
    }
  }
  describe(report, "ended at solver.loose_tolerance; the elastic tangent was returned");
  return elastic;
}

}  // namespace

template <int D>
State<D>::State(std::shared_ptr<const Material<D>> material)
    : material_(std::move(material)), committed_(material_->initial) {
  const auto& initial = material_->initial;
  // Reserves capacity in both configurations, which are swapped at every commit, for more contacts.
  for (auto* configuration : {&committed_, &trial_}) {
    configuration->contacts.reserve(initial.contacts.size() +
                                    initial.contacts.size() / state_capacity);
    configuration->coordinates.reserve(initial.coordinates.size());
  }
}

template <int D>
bool State<D>::commit() {
  if (!has_trial_) return false;
  std::swap(committed_, trial_);
  has_trial_ = false;
  return true;
}

template <int D>
grainlaw_status State<D>::evaluate(const double* given, TangentKind kind, double* P, double* A,
                                   grainlaw_report& report) {
  Tensor<D> F = effective(given);
  if (reference_) F = reference_->to_packing(F);
  Answer<D> answer;
  const auto status = follow(F, {}, kind, answer, report);
  if (status != GRAINLAW_OK) return status;
  if (reference_) answer.stress = reference_->stress_of_host(answer.stress);
  if (P != nullptr) std::copy(answer.stress.begin(), answer.stress.end(), P);
  if (A == nullptr || kind == TangentKind::none) return status;
  if (reference_) answer.tangent = reference_->tangent_of_host(answer.tangent);
  std::copy(answer.tangent.begin(), answer.tangent.end(), A);
  return status;
}

template <int D>
grainlaw_status State<D>::follow(const Tensor<D>& F, std::optional<double> duration,
                                 TangentKind kind, Answer<D>& answer, grainlaw_report& report) {
  try {
    return follow(F, duration, kind, answer, report, workspace<D>());
  } catch (...) {
    drop_workspace<D>();
    throw;
  }
}

template <int D>
grainlaw_status State<D>::follow(const Tensor<D>& F, std::optional<double> duration,
                                 TangentKind kind, Answer<D>& answer, grainlaw_report& report,
                                 Workspace<D>& w) {
  const auto split = grainlaw::core::split<D>(material_->space, F, committed_.deformation);
  const bool had_trial = std::exchange(has_trial_, false);
  if (too_far(split)) {
    report.step_ratio = 0.1;
    describe(report, "the stretch since the committed state is more than 30 %");
    return GRAINLAW_STEP_TOO_LARGE;
  }
  Problem<D> problem = material_->problem();
  if (duration) problem.inertia = false;  // the caller looks for equilibria
  const double lasts = duration ? *duration : duration_of(*material_, committed_, F, time_step_);
  const auto request = request_of(problem, split, kind, lasts, had_trial, w);
  const auto outcome = solve(request, w);
  add_outcome(w.increment, outcome, report);
  if (outcome.status != GRAINLAW_OK) {
    describe(report, grainlaw_status_text(outcome.status));
    return outcome.status;
  }

  if (const auto status = answer_of(outcome, kind, w, answer, report); status != GRAINLAW_OK)
    return status;
  keep_trial(outcome, w, report);
  if (kind == TangentKind::perturbed) {
    if (const auto status = perturb(request, w, answer.tangent, report); status != GRAINLAW_OK) {
      describe(report, "a perturbed increment found no equilibrium");
      return status;
    }
  }
  rotate_back(split, F, kind != TangentKind::none, answer);
  if (!all_finite(answer.tangent) || !all_finite(trial_)) {
    describe(report, "numbers too large: the stress, the tangent or the state overflows");
    return GRAINLAW_NOT_CONVERGED;
  }
  answer.stress = trial_.stress;
  has_trial_ = true;
  return GRAINLAW_OK;
}

// What the solver has to find, from the last trial if the material says so.
template <int D>
Request<D> State<D>::request_of(const Problem<D>& problem, const SplitIncrement<D>& split,
                                TangentKind kind, double duration, bool had_trial,
                                Workspace<D>& w) const {
  const auto& solver = material_->solver;
  Request<D> request{&problem, &solver, &committed_, split.target};
  request.turn = split.rotation_vector;
  request.tolerance = solver.tolerance;
  request.loose_tolerance = solver.loose_tolerance;
  request.sensitivities = kind == TangentKind::exact;
  request.duration = duration;
  if (had_trial && solver.start == Start::trial) {
    guess_from_trial(committed_, trial_, material_->packing.size(), w, request);
    follow_slopes<D>(trial_slopes_, w.guess_step, request);
    request.guess_loose = trial_loose_;
    request.guess_advanced = trial_advanced_;
  }
  return request;
}

// P and tangent of the increment that was solved, without its rotation.
template <int D>
grainlaw_status State<D>::answer_of(const Outcome& outcome, TangentKind kind, const Workspace<D>& w,
                                    Answer<D>& answer, grainlaw_report& report) const {
  if (loaded(w.increment)) {
    answer.stress = piola_stress(w.increment);
    answer.tangent = tangent_of(w, outcome, kind, report);
    return GRAINLAW_OK;
  }
  if (material_->solver.contacts_lost == ContactsLost::error) {
    report.step_ratio = 0.5;
    describe(report, grainlaw_status_text(GRAINLAW_CONTACTS_LOST));
    return GRAINLAW_CONTACTS_LOST;
  }
  // The packing stays free of stress nearby: the tangent is zero too.
  report.residual = 0;
  report.tangent_exact = kind == TangentKind::exact ? 1 : 0;
  describe(report, "no contact carries a force: the packing is free of stress");
  return GRAINLAW_OK;
}

// Ends the increment and writes it to the trial, without the rotation.
template <int D>
void State<D>::keep_trial(const Outcome& outcome, Workspace<D>& w, grainlaw_report& report) {
  w.increment.advance_history();
  w.increment.export_to(committed_, trial_);
  const auto& drag = w.increment.motion().drag();
  if (drag.acts()) {
    trial_.velocity = w.velocity;  // whose size stays
    trial_.strain_rate = drag.how().strain_rate;
  } else {
    trial_.velocity.clear();
  }
  trial_loose_ = outcome.loose;
  trial_advanced_ = outcome.history_advanced;
  const bool smooth = outcome.sensitivities && !outcome.loose && !outcome.history_advanced &&
                      outcome.subincrements == 1 && !material_->space.finds_deformation;
  trial_slopes_.clear();
  if (material_->solver.start == Start::trial && smooth)
    keep_slopes<D>(w.increment.problem(), w.sensitivity.motion(), trial_slopes_);
  add_contacts(w.increment, committed_, trial_, report);
  // Drag, and the file of a packing, say where a particle without contacts is.
  if (!drag.acts() && committed_.coordinates != material_->initial.coordinates)
    report.rattlers_loaded = newly_loaded(material_->space, committed_, trial_, w.loaded);
}

// Rotates the trial and the answer with the increment.
template <int D>
void State<D>::rotate_back(const SplitIncrement<D>& split, const Tensor<D>& F, bool tangent_wanted,
                           Answer<D>& answer) {
  trial_.stress = rotate_stress<D>(split, answer.stress);
  if (material_->space.bound_to_axes()) return;
  rotate_configuration(split, F, material_->packing.size(), trial_);
  if (tangent_wanted) {
    answer.tangent =
        rotate_tangent<D>(split, committed_.deformation, answer.stress, answer.tangent);
  }
}

template class State<2>;
template class State<3>;

}  // namespace grainlaw::core
