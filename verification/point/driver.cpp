#include "point/driver.hpp"

#include "point/control.hpp"
#include "point/laboratory_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace verification {
namespace {

// Iterations in a row without halving the residual that end an attempt. After the peak P(F) jumps
// where contacts collapse, and Newton alternates between its two sides. A smaller step usually
// avoids the jump.
constexpr int patience = 4;

}  // namespace

// Goal of one (part of a) step.
template <int D>
struct PointDriverOf<D>::Goal {
  Conditions<D> condition{};
  ComponentsOf<D> value = ComponentsOf<D>::Zero();
  double scale = 1;  // scale of the stress residual [Pa]
  bool mixed = false;
  std::array<bool, 3> follows{};  // mixed control: diagonal components that keep det F at `volume`
  double volume = 1;

  [[nodiscard]] bool stress(int k) const {
    return condition[static_cast<std::size_t>(k)].control != Control::deformation;
  }
  // Whether components follow; with prescribed stresses these keep the determinant.
  [[nodiscard]] bool follow() const { return mixed && (follows[0] || follows[1] || follows[2]); }
  void steer(TangentOf<D>& matrix, ComponentsOf<D>& residual,
             const TensorOf<D>& deformation) const {
    if (!follow()) return;
    follow_volume<D>(matrix, deformation, follows);
    for (int i = 0; i < D; ++i)
      if (follows[static_cast<std::size_t>(i)]) residual((D + 1) * i) = 0;
  }
};

template <int D>
struct PointDriverOf<D>::Iterate : Attempt {
  TensorOf<D> deformation = TensorOf<D>::Identity();
  EvaluationOf<D> evaluation;
  // Iterate with the largest stress error of the last step's tangent, and that error [Pa].
  TensorOf<D> farthest_deformation = TensorOf<D>::Identity();
  double far = -1;
};

template <int D>
PointDriverOf<D>::PointDriverOf(const Material& material, const PointOptions& options)
    : options_(options),
      state_(material),
      volume_(measure_scalar(state_.get(), GRAINLAW_REFERENCE_VOLUME)),
      deformation_(TensorOf<D>::Identity()),
      evaluation_(evaluate_of<D>(state_, deformation_, options.tangent)) {
  check(evaluation_.status, "evaluating the start at F = I");
  deformation_ = deformation_gradient<D>(state_.get());
  record_ = make_record<D>(state_.get(), deformation_, evaluation_.stress, evaluation_.report);
  record_.effort.add(evaluation_.report);
  state_.revert();
}

template <int D>
typename PointDriverOf<D>::Goal PointDriverOf<D>::goal_at(const Segment& segment,
                                                          const ComponentsOf<D>& start,
                                                          double volume, double fraction) const {
  Goal goal;
  goal.condition = conditions_of<D>(segment);
  goal.follows = segment.keeps_volume;
  goal.volume = volume;
  goal.scale = std::max(cauchy_stress_of<D>(evaluation_.stress, deformation_).norm(), 1.0);
  for (std::size_t k = 0; k < D * D; ++k) {
    const Target& target = segment.target[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double end = target.increment ? start(i) + target.value : target.value;
    goal.value(i) = start(i) + fraction * (end - start(i));
    goal.mixed = goal.mixed || target.control != Control::deformation;
  }
  if (segment.isochoric() && !goal.mixed)
    goal.value =
        components_of<D>(with_volume<D>(tensor_of<D>(goal.value), segment.keeps_volume, volume));
  return goal;
}

// Newton on the components of F whose stress is prescribed. The first iterate extrapolates the
// prescribed increment with the tangent of the last step. An exact tangent is renewed at every
// iterate; any other starts Broyden updates, for which a rough matrix suffices.
template <int D>
typename PointDriverOf<D>::Iterate PointDriverOf<D>::iterate(const Goal& goal, double tolerance) {
  Iterate result;
  const unsigned want = goal.mixed ? options_.tangent : 0;
  const Controlled<D> before = controlled<D>(goal.condition, deformation_, evaluation_);
  TangentOf<D> matrix = before.derivative;  // rows of prescribed F are rows of I
  ComponentsOf<D> residual = goal.value - before.value;
  goal.steer(matrix, residual, deformation_);
  ComponentsOf<D> correction = matrix.fullPivLu().solve(residual);
  ComponentsOf<D> value = before.value;
  ComponentsOf<D> deformation = components_of<D>(deformation_);
  double best = std::numeric_limits<double>::infinity();
  int best_iteration = 0;
  bool first = true;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    deformation += correction;
    result.deformation = tensor_of<D>(deformation);
    if (goal.follow()) {
      result.deformation = with_volume<D>(result.deformation, goal.follows, goal.volume);
      deformation = components_of<D>(result.deformation);
    }
    result.evaluation = evaluate_of<D>(state_, result.deformation, want);
    effort_.add(result.evaluation.report);
    if (goal.mixed) ++effort_.iterations;
    if (result.evaluation.status != GRAINLAW_OK) {
      result.status = result.evaluation.status;
      result.ratio = result.evaluation.report.step_ratio;
      const std::string text = grainlaw_status_text(result.evaluation.status);
      const std::string message = result.evaluation.report.message;
      result.reason = message.empty() || message == text ? text : text + ": " + message;
      return result;
    }
    result.deformation = deformation_gradient<D>(state_.get());
    const Controlled<D> now = controlled<D>(goal.condition, result.deformation, result.evaluation);
    residual = goal.value - now.value;
    const ComponentsOf<D> unforeseen =
        now.value - before.value -
        before.derivative * (components_of<D>(result.deformation) - components_of<D>(deformation_));
    double error = 0;
    for (int k = 0; k < D * D; ++k)
      if (goal.stress(k)) error = std::max(error, std::abs(residual(k)) / goal.scale);
    if (unforeseen.norm() > result.far) {
      result.far = unforeseen.norm();
      result.farthest_deformation = result.deformation;
    }
    if (error <= tolerance) {
      result.converged = true;
      return result;
    }
    if (error < 0.5 * best) {
      best = error;
      best_iteration = iteration;
    }
    result.stalled = std::isfinite(error) && iteration >= best_iteration + patience;
    if (result.stalled || !std::isfinite(error)) break;
    if (result.evaluation.report.tangent_exact != 0 || first) {
      matrix = now.derivative;
    } else {
      const ComponentsOf<D> mismatch = now.value - value - matrix * correction;
      matrix += mismatch * correction.transpose() / correction.squaredNorm();
    }
    value = now.value;
    goal.steer(matrix, residual, result.deformation);
    correction = matrix.fullPivLu().solve(residual);
    first = false;
  }
  result.reason =
      fmt::format("the stress control did not converge (best residual {:.1e} [-])", best);
  return result;
}

// Computes the tangent for stress control, which a last step of pure strain control lacks.
template <int D>
void PointDriverOf<D>::renew_tangent() {
  const EvaluationOf<D> again = evaluate_of<D>(state_, deformation_, options_.tangent);
  if (again.status != GRAINLAW_OK)
    throw StepError(again.status, fmt::format("evaluating the tangent at the start of a segment, "
                                              "after step {}, failed: {}",
                                              record_.step, again.report.message));
  state_.revert();
  evaluation_.tangent = again.tangent;
  has_tangent_ = true;
}

template <int D>
void PointDriverOf<D>::accept(const Iterate& iterate, bool has_tangent) {
  const TensorOf<D> change = iterate.deformation - deformation_;
  work_ +=
      0.5 * volume_ * (evaluation_.stress + iterate.evaluation.stress).cwiseProduct(change).sum();
  deformation_ = iterate.deformation;
  evaluation_ = iterate.evaluation;
  has_tangent_ = has_tangent;
}

// Crosses jumps from a stalled attempt and its iterate furthest beyond.
template <int D>
typename PointDriverOf<D>::Iterate PointDriverOf<D>::cross_jumps(const Goal& goal, Iterate last) {
  for (int crossing = 0; crossing < most_crossings && last.stalled; ++crossing) {
    Iterate beyond = last;
    beyond.deformation = last.farthest_deformation;
    beyond.evaluation = evaluate_of<D>(state_, beyond.deformation, options_.tangent);
    effort_.add(beyond.evaluation.report);
    if (beyond.evaluation.status != GRAINLAW_OK) return last;
    accept(beyond, true);
    state_.commit();
    ++effort_.crossed;
    last = iterate(goal, options_.tolerance);
  }
  if (last.stalled) last.converged = last.loose = true;  // the next part continues from here
  return last;
}

template <int D>
TestEnd PointDriverOf<D>::run(const Segment& segment, const PointObserver& observe,
                              const CutObserver& observe_cut) {
  if (segment.test) return run_element_test<D>(*this, *segment.test, observe, observe_cut);
  run_steps(segment, observe, observe_cut);
  return {};
}

template <int D>
bool PointDriverOf<D>::run_steps(const Segment& segment, const PointObserver& observe,
                                 const CutObserver& observe_cut, const PointJudgeOf<D>& may_stay) {
  const ComponentsOf<D> start =
      controlled<D>(conditions_of<D>(segment), deformation_, evaluation_).value;
  const double volume = segment.volume > 0 ? segment.volume : deformation_.determinant();
  if (goal_at(segment, start, volume, 0).mixed && !has_tangent_) renew_tangent();
  for (int step = 1; step <= segment.steps; ++step) {
    if (left()) return true;
    const int number = record_.step + 1;
    std::optional<PointDriverOf> before;
    if (may_stay) before.emplace(*this);
    double done = 0;
    double fraction = 0;
    TensorOf<D> committed;
    const auto attempt = [&](double next, bool loose) {
      fraction = (step - 1 + next) / segment.steps;
      const Goal goal = goal_at(segment, start, volume, fraction);
      check(grainlaw_state_set_time_step(state_.get(), next - done), "telling the time step");
      Iterate last = iterate(goal, loose ? options_.loose_tolerance : options_.tolerance);
      if (last.stalled && options_.loose_tolerance == 0 && next - done <= crossing_part) {
        last = cross_jumps(goal, last);
      }
      if (last.converged) {
        done = next;
        committed = deformation_;
        accept(last, goal.mixed);
        effort_.history_advanced += last.evaluation.report.history_advanced;
        if (next < 1) state_.commit();
      } else {
        ++effort_.cuts;
        state_.revert();
      }
      return Attempt(last);
    };
    const std::string name = fmt::format("step {} (from F{}{} = {:.6f}, F12 = {:.6f})", number, D,
                                         D, deformation_(D - 1, D - 1), deformation_(0, 1));
    const Parts parts = solve_in_parts(0, 1, name, options_.max_cuts, options_.loose_tolerance > 0,
                                       attempt, observe_cut);
    effort_.loose += parts.loose;
    record_ = make_record<D>(state_.get(), deformation_, evaluation_.stress, evaluation_.report);
    record_.step = number;
    record_.external_work = work_;
    if (may_stay && !may_stay(record_)) {
      before->effort_ = effort_;
      *this = std::move(*before);
      return false;
    }
    record_.effort = std::exchange(effort_, {});
    if (observe) observe({state_, committed, evaluation_, record_, fraction});
    state_.commit();
  }
  return true;
}

template class PointDriverOf<2>;
template class PointDriverOf<3>;

}  // namespace verification
