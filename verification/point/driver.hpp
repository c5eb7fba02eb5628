// One integration point driven along a path of mixed strain and stress control.
#pragma once

#include "app/library.hpp"
#include "app/parts.hpp"
#include "app/record.hpp"
#include "point/path.hpp"

#include <functional>

namespace verification {

struct PointOptions {
  unsigned tangent = GRAINLAW_WANT_TANGENT_EXACT;  // matrix of the stress control
  // Those of the march; residuals are the largest of a stress / |sigma| at the start of the step.
  double tolerance = grainlaw_march_options_default().tolerance;
  int max_iterations = grainlaw_march_options_default().max_iterations;
  int max_cuts = 12;  // more than a mesh makes: a part costs one point
  // Residual accepted at the smallest part of a step, counted as a loose step [-]. Where P(F) jumps
  // across the target no smaller step helps. 0: the jump is crossed: the state beyond is committed
  // out of balance, then balanced.
  double loose_tolerance = 0;
  int max_steps = 0;  // after which a path ends; 0: no limit
};

// View of an observer at the end of every full step, before the commit.
template <int D>
struct PointStepOf {
  State& state;                       // committed: the (part of a) step before; trial: this one
  TensorOf<D> committed_deformation;  // F of the committed state
  const EvaluationOf<D>& evaluation;  // of the trial
  const RecordOf<D>& record;
  double fraction;  // progress in the segment, 0..1
};
template <int D>
using PointObserverOf = std::function<void(const PointStepOf<D>&)>;
// Whether a step may stay, by its record.
template <int D>
using PointJudgeOf = std::function<bool(const RecordOf<D>&)>;

template <int D>
class PointDriverOf {
 public:
  using PointStep = PointStepOf<D>;
  using PointObserver = PointObserverOf<D>;

  // Starts at F = I. The state shares ownership of the material.
  PointDriverOf(const Material& material, const PointOptions& options);

  // Runs one segment. Throws StepError with its place when a step fails at its smallest part;
  // earlier parts stay done.
  TestEnd run(const Segment& segment, const PointObserver& observe,
              const CutObserver& observe_cut = {});
  // A segment without a test. A step that may not stay is taken back before anybody observes it, and
  // the rest is left: false.
  bool run_steps(const Segment& segment, const PointObserver& observe,
                 const CutObserver& observe_cut = {}, const PointJudgeOf<D>& may_stay = {});

  // Whether max_steps is reached.
  [[nodiscard]] bool left() const {
    return options_.max_steps > 0 && record_.step >= options_.max_steps;
  }
  [[nodiscard]] const RecordOf<D>& record() const { return record_; }
  // Effort of a step that failed.
  [[nodiscard]] const Effort& unfinished() const { return effort_; }
  [[nodiscard]] const grainlaw_state* state() const { return state_.get(); }

 private:
  struct Goal;
  class Maker;
  Goal goal_at(const Segment& segment, const ComponentsOf<D>& start, double volume,
               double fraction) const;
  void accept(const TensorOf<D>& deformation, const EvaluationOf<D>& evaluation, bool has_tangent);
  void renew_tangent();

  PointOptions options_;
  State state_;
  double volume_;               // at F = I [m3]
  TensorOf<D> deformation_;     // committed F
  EvaluationOf<D> evaluation_;  // evaluation of the committed F
  RecordOf<D> record_;          // record of the last step
  Effort effort_;               // effort of the present step
  bool has_tangent_ = true;
  double work_ = 0;  // external work since F = I [J]
};

using PointStep = PointStepOf<2>;
using PointObserver = PointObserverOf<2>;
using PointDriver = PointDriverOf<2>;

}  // namespace verification
