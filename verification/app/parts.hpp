// Load steps in parts, as the library's march leads them.
#pragma once

#include "app/library.hpp"

#include <fmt/format.h>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace verification {

// What ended an attempt at a part of a step.
struct Refusal {
  std::string reason;
  double ratio = std::numeric_limits<double>::quiet_NaN();  // suggested for the part; NaN: none is
  grainlaw_status status = GRAINLAW_OK;  // of a failed evaluation; OK: all succeeded
};

// A step that failed at its smallest part. `status` is that of the failed evaluation, OK when all
// succeeded.
struct StepError : ComputationError {
  StepError(grainlaw_status status_, const std::string& text)
      : ComputationError(text), status(status_) {}
  grainlaw_status status;
};

// Called at every cut with the next part over the step, and the reason.
using CutObserver = std::function<void(double part, const std::string& reason)>;
inline std::string describe_cut(int step, double part, const std::string& reason) {
  return fmt::format("step {} in parts of {:.1e} of it: {}", step, part, reason);
}

inline constexpr int most_cuts = 30;  // that a scene may ask for; smaller parts are below rounding

// A step from one load to another.
struct Step {
  double from = 0;
  double to = 1;
  std::string name;  // in messages
  grainlaw_march_options options = grainlaw_march_options_default();
  // Tolerance of the rest of the step, tried once where its smallest part failed; 0: it is not [-].
  double loose_tolerance = 0;
  CutObserver observe_cut = {};
};

// What a maker tells the march.
class Telling {
 public:
  explicit Telling(grainlaw::March& march) : march_(march) {}

  // Share of a correction to apply; 0 for a change that is not finite, which ends the attempt.
  double share(double largest_change) { return march_.share(largest_change); }
  // Tells a relative residual, and the change of forces that the committed stiffness does not explain.
  void found(double residual, double unforeseen = -1) {
    march_.tell(GRAINLAW_OK, residual, 1, unforeseen);
  }
  void refused(const Refusal& refusal);

  // Status of a refusal since the last call.
  grainlaw_status take_status() { return std::exchange(status_, GRAINLAW_OK); }

 private:
  grainlaw::March& march_;
  grainlaw_status status_ = GRAINLAW_OK;
};

// Makes a step as the march asks; see grainlaw/march.h.
class StepMaker {
 public:
  StepMaker() = default;
  virtual ~StepMaker() = default;
  StepMaker(const StepMaker&) = delete;
  StepMaker& operator=(const StepMaker&) = delete;

  // Begins an attempt at a load; `length` is its way from the last load in balance.
  virtual void begin(double load, double length) = 0;
  // Solves once and tells.
  virtual void solve(Telling& tell) = 0;
  // Keeps the iterate, and returns to the one that was kept last and tells.
  virtual void keep() = 0;
  virtual void cross(Telling& tell) = 0;
  // Commits; `beyond`: what lies beyond a jump, to be balanced from there.
  virtual void accept(bool beyond) = 0;
  // Returns to what is committed; `left`: beyond a jump, and left out of balance.
  virtual void back(bool left) = 0;
};

// Counts of a step.
struct Parts {
  int solves = 0;
  int cuts = 0;
  int crossed = 0;  // jumps
  int loose = 0;
};

// Makes a step. Throws StepError with its name.
Parts make_step(const Step& step, StepMaker& maker);

// Makes a step whose maker iterates by itself: attempt(load, length) goes from the last success to the
// load and commits, or changes nothing and tells why.
using PartAttempt = std::function<std::optional<Refusal>(double load, double length)>;
Parts make_step(const Step& step, const PartAttempt& attempt);

}  // namespace verification
