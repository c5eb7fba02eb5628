#include "point/driver.hpp"

#include "point/control.hpp"
#include "point/laboratory_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace verification {
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
class PointDriverOf<D>::Maker final : public StepMaker {
 public:
  // The goal at a share of the step.
  using GoalAt = std::function<Goal(double load)>;

  Maker(PointDriverOf& driver, GoalAt goal_at) : driver_(driver), goal_at_(std::move(goal_at)) {}

  // F that was committed before the last part.
  [[nodiscard]] const TensorOf<D>& committed() const { return committed_; }
  // Whether the end of the step is to be committed.
  [[nodiscard]] bool has_trial() const { return has_trial_; }

  void begin(double load, double length) override {
    check(grainlaw_state_set_time_step(driver_.state_.get(), length), "telling the time step");
    if (!beyond_ || load != load_) goal_ = goal_at_(load);  // with the scale of the part's start
    load_ = load;
    start_ = value_ = controlled<D>(goal_.condition, driver_.deformation_, driver_.evaluation_);
    matrix_ = start_.derivative;  // rows of prescribed F are rows of I
    deformation_ = driver_.deformation_;
    asked_ = components_of<D>(deformation_);
    first_ = true;
  }

  void solve(Telling& tell) override {
    ComponentsOf<D> residual = goal_.value - value_.value;
    goal_.steer(matrix_, residual, deformation_);
    const ComponentsOf<D> correction = matrix_.fullPivLu().solve(residual);
    asked_ += correction;
    if (goal_.follow())
      asked_ = components_of<D>(with_volume<D>(tensor_of<D>(asked_), goal_.follows, goal_.volume));
    if (goal_.mixed) ++driver_.effort_.iterations;
    const ComponentsOf<D> before = value_.value;
    if (!evaluate(tensor_of<D>(asked_), goal_.mixed ? driver_.options_.tangent : 0, tell)) return;
    if (std::exchange(first_, false) || evaluation_.report.tangent_exact != 0) {
      matrix_ = value_.derivative;
    } else {
      const ComponentsOf<D> mismatch = value_.value - before - matrix_ * correction;
      matrix_ += mismatch * correction.transpose() / correction.squaredNorm();
    }
  }

  void keep() override { farthest_ = deformation_; }
  void cross(Telling& tell) override { evaluate(farthest_, driver_.options_.tangent, tell); }

  void accept(bool beyond) override {
    committed_ = driver_.deformation_;
    driver_.accept(deformation_, evaluation_, goal_.mixed);
    if (beyond)
      ++driver_.effort_.crossed;
    else
      driver_.effort_.history_advanced += evaluation_.report.history_advanced;
    beyond_ = beyond;
    has_trial_ = !beyond && load_ == 1;  // the end is shown to observers before
    if (!has_trial_) driver_.state_.commit();
  }

  void back(bool left) override {
    if (!left) ++driver_.effort_.cuts;
    driver_.state_.revert();
  }

 private:
  // Evaluates and tells; false: the point refuses.
  bool evaluate(const TensorOf<D>& deformation, unsigned want, Telling& tell) {
    evaluation_ = evaluate_of<D>(driver_.state_, deformation, want);
    const grainlaw_report& report = evaluation_.report;
    driver_.effort_.add(report);
    if (evaluation_.status != GRAINLAW_OK) {
      const std::string text = grainlaw_status_text(evaluation_.status), message = report.message;
      tell.refused({.reason = message.empty() || message == text ? text : text + ": " + message,
                    .ratio = report.step_ratio,
                    .status = evaluation_.status});
      return false;
    }
    deformation_ = deformation_gradient<D>(driver_.state_.get());
    value_ = controlled<D>(goal_.condition, deformation_, evaluation_);
    double error = 0;
    for (int k = 0; k < D * D; ++k)
      if (goal_.stress(k))
        error = std::max(error, std::abs(goal_.value(k) - value_.value(k)) / goal_.scale);
    const ComponentsOf<D> change =
        components_of<D>(deformation_) - components_of<D>(driver_.deformation_);
    tell.found(error, (value_.value - start_.value - start_.derivative * change).norm());
    return true;
  }

  PointDriverOf& driver_;
  GoalAt goal_at_;
  double load_ = 0;
  Goal goal_;
  Controlled<D> start_;  // of the committed state
  TangentOf<D> matrix_;
  ComponentsOf<D> asked_;  // F of the iterate, before components that its boundary finds
  bool first_ = true;
  TensorOf<D> deformation_;  // of the iterate, with its evaluation and what is prescribed of it
  EvaluationOf<D> evaluation_;
  Controlled<D> value_;
  TensorOf<D> farthest_ = TensorOf<D>::Identity();
  TensorOf<D> committed_ = TensorOf<D>::Identity();
  bool beyond_ = false;
  bool has_trial_ = false;
};

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
void PointDriverOf<D>::accept(const TensorOf<D>& deformation, const EvaluationOf<D>& evaluation,
                              bool has_tangent) {
  const TensorOf<D> change = deformation - deformation_;
  work_ += 0.5 * volume_ * (evaluation_.stress + evaluation.stress).cwiseProduct(change).sum();
  deformation_ = deformation;
  evaluation_ = evaluation;
  has_tangent_ = has_tangent;
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
    const auto fraction = [&](double load) { return (step - 1 + load) / segment.steps; };
    Maker maker(*this,
                [&](double load) { return goal_at(segment, start, volume, fraction(load)); });
    grainlaw_march_options march = grainlaw_march_options_default();
    march.tolerance = options_.tolerance;
    march.max_iterations = options_.max_iterations;
    march.max_cuts = options_.max_cuts;
    const Parts parts =
        make_step({.name = fmt::format("step {} (from F{}{} = {:.6f}, F12 = {:.6f})", number, D, D,
                                       deformation_(D - 1, D - 1), deformation_(0, 1)),
                   .options = march,
                   .loose_tolerance = options_.loose_tolerance,
                   .observe_cut = observe_cut},
                  maker);
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
    if (observe) observe({state_, maker.committed(), evaluation_, record_, fraction(1)});
    if (maker.has_trial()) state_.commit();
  }
  return true;
}

template class PointDriverOf<2>;
template class PointDriverOf<3>;

}  // namespace verification
