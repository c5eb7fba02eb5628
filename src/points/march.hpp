// The march through a load step: parts, cuts, patience and jumps. Knows no points and no unknowns.
#pragma once

#include <grainlaw/grainlaw.h>

namespace grainlaw::core {

// Numbers of step control, chosen by judgement; hosts have the defaults as grainlaw_march_options.
namespace stepping {
// Shortest and longest part that follows one that failed, over it [-]. The suggestion of a point
// lies between; where Newton's method failed the longest is tried.
inline constexpr double smallest_cut = 0.1, largest_cut = 0.5;
inline constexpr double growth = 2;       // of parts that succeed after a cut [-]
inline constexpr double rounding = 1e-9;  // rest of a load step that is rounding, over the step [-]
inline constexpr double progress = 0.5;   // reduction of the residual that counts as progress [-]
inline constexpr double noise = 1e-12;    // relative residual that may be rounding alone [-]
inline constexpr double largest_loose = 1;  // relative residual of a loose part [-]
}  // namespace stepping

// The default options. Newton alternates across a jump of P, which a smaller step usually avoids, but
// hardly below 1/16 of a load step.
[[nodiscard]] grainlaw_march_options default_march_options();

// Outcome of one solve and evaluation, of all ranks together.
struct Told {
  bool found = false;      // all points found their equilibrium
  double step_ratio = 0;   // suggested where not
  double residual = 0;     // relative [-]
  double unforeseen = -1;  // distance from what the committed stiffness foresees; negative: unknown
  const char* reason = "";
};

// Whether the options are within their ranges.
[[nodiscard]] bool valid(const grainlaw_march_options& options);

// Factor on a part that failed, from the suggestion of its points.
[[nodiscard]] double cut_ratio(double step_ratio);

class March {
 public:
  explicit March(const grainlaw_march_options& options) : options_(options) {}

  void begin(double from, double to);

  // Returns what the host does now. After an ACCEPT or BACK it begins the next attempt.
  grainlaw_action next();

  // Share of a correction that is within its bound; 0 for one that is not finite.
  [[nodiscard]] double bound(double largest_change) const;
  // Takes the share that is applied; 0 ends the attempt.
  void apply(double share);
  void tell(const Told& told);

  // Whether next() asked for something to be told.
  [[nodiscard]] bool asks() const;
  // Whether the next solve is the first of its attempt.
  [[nodiscard]] bool begins_attempt() const { return action_ == GRAINLAW_SOLVE && iteration_ == 0; }
  [[nodiscard]] const grainlaw_march_options& options() const { return options_; }
  [[nodiscard]] const grainlaw_part& part() const { return part_; }

 private:
  void begin_attempt();
  void end_part();
  void judge(const Told& told);
  void end_without_convergence(double residual);
  void judge_crossing(const Told& told);
  void fail(double ratio, const char* reason);
  void accept(bool ends_part);
  void give_up(const char* reason);
  // Whether what lies beyond the last jump is too far from balance to go on from.
  [[nodiscard]] bool too_loose() const;
  void give_up_beyond(const char* reason);
  void decide(grainlaw_action action);
  // A length along the step; steps may go down.
  [[nodiscard]] double along(double length) const { return to_ < from_ ? -length : length; }
  [[nodiscard]] double whole() const { return along(to_ - from_); }

  grainlaw_march_options options_;
  double from_ = 0, to_ = 0;
  double done_ = 0;    // committed in balance
  double length_ = 0;  // of the next part, signed
  grainlaw_action action_ = GRAINLAW_GIVE_UP;
  bool returned_ = false;   // by next()
  bool ends_part_ = false;  // the action: the next part follows
  int crossings_ = 0;       // of this part; the last is committed
  double beyond_ = 0;       // residual where the last crossing led
  int iteration_ = 0;       // solves told in this attempt
  bool whole_ = true;       // the correction told next is applied whole
  bool loaded_ = false;     // one of this attempt was
  double best_ = 0;         // residual of the last progress
  int best_iteration_ = 0;
  double farthest_ = -1;  // distance of the iterate that is kept; negative: none
  grainlaw_part part_{};
};

}  // namespace grainlaw::core
