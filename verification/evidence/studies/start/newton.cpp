#include "evidence/studies/start/newton.hpp"

#include "evidence/studies/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace verification::start {
namespace {

constexpr int most_halvings = 2;  // of a step that does not converge
constexpr int part_iterations = 8;

// The lateral stress and its derivatives with respect to F11 and F22 [Pa].
struct LateralStress {
  double value;
  double by_lateral;
  double by_axial;

  LateralStress(Lateral kind, const Evaluation& evaluation, const Tensor& deformation) {
    const bool piola = kind == Lateral::piola;
    const Tangent derivative =
        piola ? evaluation.tangent
              : cauchy_tangent(evaluation.stress, evaluation.tangent, deformation);
    value = piola ? evaluation.stress(0, 0) : cauchy_stress(evaluation.stress, deformation)(0, 0);
    by_lateral = derivative(0, 0);
    by_axial = derivative(0, 3);
  }
};

class Stepper {
 public:
  Stepper(const Material& material, const NewtonOptions& options)
      : options_(options),
        state_(material),
        evaluation_(evaluate(state_, deformation_, GRAINLAW_WANT_TANGENT_EXACT)),
        target_(LateralStress(options.lateral, evaluation_, deformation_).value) {
    check(evaluation_.status, "evaluating the start at F = I");
    state_.revert();
  }

  // False: not even a part of the step could be evaluated.
  bool advance(double axial_stretch, Step& step) {
    const double start = cpu_milliseconds();
    step.converged = attempt(axial_stretch, step, true);
    const bool done = step.converged || advance_in_parts(axial_stretch, step);
    step.cpu = cpu_milliseconds() - start;
    if (step.converged) step.dependence = dependence();
    if (done) commit();
    return done;
  }

 private:
  // Newton's iterations; the last trial is in trial_, the iterates in `step` when they are to be
  // kept.
  bool attempt(double axial_stretch, Step& step, bool keep) {
    const LateralStress before(options_.lateral, evaluation_, deformation_);
    trial_deformation_ = deformation_;
    trial_deformation_(1, 1) = axial_stretch;
    const double change = axial_stretch - deformation_(1, 1);
    trial_deformation_(0, 0) +=
        (target_ - before.value - before.by_axial * change) / before.by_lateral;
    best_ = std::numeric_limits<double>::infinity();
    const int most = keep ? options_.max_iterations : part_iterations;
    for (int iteration = 0; iteration < most; ++iteration) {
      ++step.evaluations;
      trial_ = evaluate(state_, trial_deformation_, GRAINLAW_WANT_TANGENT_EXACT);
      const grainlaw_report& report = trial_.report;
      if (keep) {
        ++step.iterations;
        if (report.subincrements > 1 || report.history_advanced != 0) ++step.not_direct;
      }
      if (trial_.status != GRAINLAW_OK) {
        if (keep) step.reason = grainlaw_status_text(trial_.status);
        return false;
      }
      const LateralStress now(options_.lateral, trial_, trial_deformation_);
      const double residual = (now.value - target_) / std::abs(target_);
      if (keep) step.iterates.push_back({trial_deformation_(0, 0), residual});
      if (std::abs(residual) <= options_.tolerance) return true;
      if (std::abs(residual) < best_) {
        best_ = std::abs(residual);
        best_deformation_ = trial_deformation_;
      }
      trial_deformation_(0, 0) += (target_ - now.value) / now.by_lateral;
    }
    if (keep) step.reason = "no convergence";
    return false;
  }

  // All but the last part are committed here.
  bool advance_in_parts(double axial_stretch, Step& step) {
    const double whole = axial_stretch - deformation_(1, 1);
    double part = 0.5;
    double done = 0;
    step.parts = 0;
    while (true) {
      state_.revert();
      const double next = std::min(1.0, done + part);
      const double to = axial_stretch - (1 - next) * whole;
      if (!attempt(to, step, false)) {
        part *= 0.5;
        if (part >= std::ldexp(1.0, -most_halvings)) continue;
        if (!accept_loosely(axial_stretch, step)) return false;
        return true;
      }
      ++step.parts;
      if (next == 1) return true;
      commit();
      done = next;
    }
  }

  // The best iterate of the rest of the step, in one part.
  bool accept_loosely(double axial_stretch, Step& step) {
    state_.revert();
    if (!attempt(axial_stretch, step, false)) {
      state_.revert();
      if (!std::isfinite(best_)) return false;
      trial_deformation_ = best_deformation_;
      trial_ = evaluate(state_, trial_deformation_, GRAINLAW_WANT_TANGENT_EXACT);
      ++step.evaluations;
      ++step.loose;
    }
    ++step.parts;
    return trial_.status == GRAINLAW_OK;
  }

  [[nodiscard]] double dependence() const {
    State alone = state_;
    alone.revert();
    const Evaluation again = evaluate(alone, trial_deformation_, 0);
    if (again.status != GRAINLAW_OK) return std::numeric_limits<double>::quiet_NaN();
    return (trial_.stress - again.stress).norm() / again.stress.norm();
  }

  void commit() {
    state_.commit();
    deformation_ = trial_deformation_;
    evaluation_ = trial_;
  }

  NewtonOptions options_;
  State state_;
  Tensor deformation_ = Tensor::Identity();  // committed
  Evaluation evaluation_;                    // of it
  double target_;                            // [Pa]
  Tensor trial_deformation_ = Tensor::Identity();
  Evaluation trial_;
  Tensor best_deformation_ = Tensor::Identity();
  double best_ = 0;
};

}  // namespace

double Step::best_residual() const {
  double best = std::numeric_limits<double>::infinity();
  for (const Iterate& iterate : iterates) best = std::min(best, std::abs(iterate.residual));
  return best;
}

Step::Gap Step::gap(double axial_increment) const {
  Gap nearest{std::numeric_limits<double>::infinity(), 0};
  for (const Iterate& a : iterates)
    for (const Iterate& b : iterates) {
      if (!(a.residual < 0 && b.residual > 0)) continue;
      const double width = std::abs(a.lateral_stretch - b.lateral_stretch) / axial_increment;
      if (width < nearest.width) nearest = {width, b.residual - a.residual};
    }
  return nearest;
}

void lead(Run& run, const Material& material, const NewtonOptions& options,
          const std::function<void(const Step&)>& observe) {
  Stepper stepper(material, options);
  for (int number = 1; number <= options.steps; ++number) {
    Step step;
    step.step = number;
    step.strain = options.axial * number / options.steps;
    const bool done = stepper.advance(1 - step.strain, step);
    run.steps.push_back(step);
    observe(step);
    if (done) continue;
    run.gave_up = fmt::format("step {}: {}", number, step.reason);
    return;
  }
}

}  // namespace verification::start
