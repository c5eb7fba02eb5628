#include "evidence/studies/reach/paths.hpp"

#include "evidence/studies/clock.hpp"
#include "evidence/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace verification::reach {
namespace {

constexpr int most_halvings = 8;         // of an increment that fails, to get over it
constexpr double least_pressure = 0.01;  // of that at the start; below, increments lead nowhere
constexpr double steepest_answer = 2;    // |dF11 / dF22| of the kept lateral stress, at most

double pressure(const Evaluation& evaluation, const Tensor& deformation) {
  return -0.5 * cauchy_stress(evaluation.stress, deformation).trace();
}

Ending ending(const Evaluation& evaluation) {
  if (evaluation.status != GRAINLAW_OK) return Ending::failed;
  if (evaluation.report.history_advanced != 0) return Ending::advanced;
  return evaluation.report.subincrements > 1 ? Ending::subincrements : Ending::direct;
}

// A state on its way along a path.
class Walker {
 public:
  Walker(Path& path, const Material& material)
      : path_(path),
        state_(material),
        evaluation_(evaluate(state_, deformation_, GRAINLAW_WANT_TANGENT_EXACT)),
        start_pressure_(pressure(evaluation_, deformation_)) {
    check(evaluation_.status, "evaluating the start at F = I");
    state_.revert();
  }

  [[nodiscard]] const Tensor& deformation() const { return deformation_; }
  [[nodiscard]] const Evaluation& evaluation() const { return evaluation_; }
  // Now / at the start.
  [[nodiscard]] double pressure_ratio() const {
    return pressure(evaluation_, deformation_) / start_pressure_;
  }

  // False: too little is left of the pressure, and the path has given up.
  bool bears() {
    if (pressure_ratio() >= least_pressure) return true;
    path_.gave_up =
        fmt::format("the pressure has fallen to {:.2g} of that at the start", pressure_ratio());
    return false;
  }

  // One evaluation at the target, from the committed state; leaves the trial.
  Evaluation solve(const Tensor& target) {
    const double start = cpu_milliseconds();
    Evaluation result = evaluate(state_, target, GRAINLAW_WANT_TANGENT_EXACT);
    cpu_ = cpu_milliseconds() - start;
    return result;
  }

  void describe(const Tensor& target, const Evaluation& result, double strain,
                const Observer& observe) {
    Increment increment;
    increment.step = static_cast<int>(path_.increments.size()) + 1;
    increment.strain = strain;
    const double change = (target - deformation_).cwiseAbs().maxCoeff();
    increment.hardness = change * path_.stiffness / pressure_ratio();
    increment.ending = ending(result);
    increment.status = result.status;
    increment.report = result.report;
    increment.cpu = cpu_;
    path_.increments.push_back(increment);
    observe(increment);
  }

  void commit(const Tensor& target, const Evaluation& result) {
    state_.commit();
    deformation_ = target;
    evaluation_ = result;
    path_.pressure = pressure_ratio();
  }

  // Takes over where a driver came to.
  void replace(State state, const Tensor& deformation, const Evaluation& evaluation) {
    state_ = std::move(state);
    deformation_ = deformation;
    evaluation_ = evaluation;
    path_.pressure = pressure_ratio();
  }

  // Solves the increment to the target, counts it, and gets there or as far as parts of it lead.
  // False: nowhere, and the path has given up.
  bool advance(const Tensor& target, double strain, const Observer& observe) {
    Evaluation result = solve(target);
    describe(target, result, strain, observe);
    if (result.status == GRAINLAW_OK) {
      commit(target, result);
      return true;
    }
    const Tensor start = deformation_;
    double done = 0;
    double part = 0.5;
    const double smallest = std::ldexp(1.0, -most_halvings);
    while (done < 1 && part >= smallest) {
      const Tensor between = start + (done + part) * (target - start);
      result = solve(between);
      if (result.status == GRAINLAW_OK) {
        commit(between, result);
        done += part;
      } else {
        part *= 0.5;
      }
    }
    if (done > 0) return true;
    path_.gave_up = fmt::format("{} at F22 = {:.6f}, F12 = {:.6f}",
                                grainlaw_status_text(result.status), start(1, 1), start(0, 1));
    return false;
  }

 private:
  Path& path_;
  State state_;  // committed
  Tensor deformation_ = Tensor::Identity();
  Evaluation evaluation_;  // of the committed state
  double start_pressure_;  // [Pa]
  double cpu_ = 0;         // of the last solve [ms]
};

// The increment of F that compresses the packing and, by the tangent, brings the lateral stress back
// to where it belongs; its largest component is `size`.
Tensor drained_increment(const Walker& walker, double lateral, double size) {
  const Tensor& deformation = walker.deformation();
  const Evaluation& evaluation = walker.evaluation();
  const Tangent spatial = cauchy_tangent(evaluation.stress, evaluation.tangent, deformation);
  const double missing = lateral - cauchy_stress(evaluation.stress, deformation)(0, 0);
  double answer = (missing + spatial(0, 3) * size) / spatial(0, 0) / size;
  if (!std::isfinite(answer)) answer = 0;
  answer = std::clamp(answer, -steepest_answer, steepest_answer);
  Tensor increment = Tensor::Zero();
  increment(0, 0) = answer * size;
  increment(1, 1) = -size;
  return increment / std::max(std::abs(answer), 1.0);
}

}  // namespace

void lead_drained(Path& path, const Material& material, double axial, int steps,
                  const Observer& observe) {
  Walker walker(path, material);
  PointDriver driver(material, study_options());
  try {
    driver.run(drained_segment(-axial, drained_pressure, steps), [&](const PointStep& step) {
      const Tensor& target = step.record.deformation;
      const Evaluation result = walker.solve(target);
      walker.describe(target, result, step.record.axial_strain(), observe);
      State led = step.state;
      led.commit();
      walker.replace(std::move(led), target, step.evaluation);
    });
  } catch (const ComputationError& error) {
    path.gave_up = error.what();
  }
}

void lead_shear(Path& path, const Material& material, double shear, int steps,
                const Observer& observe) {
  Walker walker(path, material);
  for (int step = 1; step <= steps; ++step) {
    Tensor target = Tensor::Identity();
    target(0, 1) = shear * step / steps;
    if (!walker.advance(target, target(0, 1), observe)) return;
  }
}

double SmallIncrements::size(double stiffness) const {
  return std::min(largest, hardness / stiffness);
}

int SmallIncrements::steps(double stiffness) const {
  return static_cast<int>(std::min<double>(most, std::ceil(strain / size(stiffness) - 1e-9)));
}

void lead_small_drained(Path& path, const Material& material, const SmallIncrements& limits,
                        const Observer& observe) {
  Walker walker(path, material);
  const double lateral = cauchy_stress(walker.evaluation().stress, walker.deformation())(0, 0);
  const int steps = limits.steps(path.stiffness);
  for (int step = 1; step <= steps && walker.bears(); ++step) {
    const double size = limits.size(path.stiffness / walker.pressure_ratio());
    const Tensor target = walker.deformation() + drained_increment(walker, lateral, size);
    if (!walker.advance(target, 1 - target(1, 1), observe)) return;
  }
}

void lead_small_shear(Path& path, const Material& material, const SmallIncrements& limits,
                      const Observer& observe) {
  Walker walker(path, material);
  const int steps = limits.steps(path.stiffness);
  for (int step = 1; step <= steps && walker.bears(); ++step) {
    Tensor target = walker.deformation();
    target(0, 1) += limits.size(path.stiffness / walker.pressure_ratio());
    if (!walker.advance(target, target(0, 1), observe)) return;
  }
}

}  // namespace verification::reach
