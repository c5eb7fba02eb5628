// One integration point led along a path of mixed strain and stress control.
#pragma once

#include "app/library.hpp"
#include "app/parts.hpp"
#include "app/record.hpp"
#include "point/path.hpp"

#include <functional>

namespace verification {

struct PointOptions {
  unsigned tangent = GRAINLAW_WANT_TANGENT_EXACT;  // matrix of the stress control
  double tolerance = 1e-8;  // largest stress residual / |sigma| at the start of the step [-]
  int max_iterations = 20;  // of one attempt, then the step is cut
  int max_cuts = 12;        // halvings of one step, at most, before the run is given up
  // Where P(F) jumps across the target no step size helps. 0: the jump is crossed: what lies beyond is
  // committed out of balance, and brought to balance from there. Else, once a step is at its smallest,
  // this tolerance holds instead of the first, and the record counts it as a loose step [-].
  double loose_tolerance = 0;
  int max_steps = 0;  // after which a path is left; 0: none
};

// What an observer sees at the end of every full step, before the trial is committed.
struct PointStep {
  grainlaw_state* state;         // committed: the (part of a) step before; trial: this one
  Tensor committed_deformation;  // F of the committed state
  const Evaluation& evaluation;  // of the trial
  const Record& record;
  double fraction;  // of the segment, 0..1
};
using PointObserver = std::function<void(const PointStep&)>;

class PointDriver {
 public:
  // Starts at F = I. The material must outlive nothing: the state keeps it alive.
  PointDriver(const Material& material, const PointOptions& options);

  // Runs one segment. Throws StepError, saying where, when a step fails at its smallest cut;
  // the parts before it stay done.
  void run(const Segment& segment, const PointObserver& observe,
           const CutObserver& observe_cut = {});

  [[nodiscard]] const Record& record() const { return record_; }
  // Of the step that did not end, after an error.
  [[nodiscard]] const Effort& unfinished() const { return effort_; }
  [[nodiscard]] grainlaw_state* state() const { return state_.get(); }

 private:
  struct Goal;
  struct Iterate;
  Goal goal_at(const Segment& segment, const Vector4& start, double fraction) const;
  Iterate iterate(const Goal& goal, double tolerance);
  Iterate cross_jumps(const Goal& goal, Iterate last);
  void accept(const Iterate& iterate, bool has_tangent);
  void renew_tangent();

  PointOptions options_;
  State state_;
  double volume_;          // at F = I [m3]
  Tensor deformation_;     // committed F
  Evaluation evaluation_;  // that led to it
  Record record_;          // of the last step
  Effort effort_;          // of the step that is being made
  bool has_tangent_ = true;
  double work_ = 0;  // external, since F = I [J]
};

}  // namespace verification
