#include "points/march.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace grainlaw::core {

namespace {

constexpr int most_cuts = 1000;  // 2^-1000 of a step is a number yet
constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <class... Values>
void write(grainlaw_part& part, const char* format, Values... values) {
  std::snprintf(part.message, sizeof part.message, format, values...);
}

}  // namespace

grainlaw_march_options default_march_options() {
  return {.size = sizeof(grainlaw_march_options),
          .tolerance = 1e-8,
          .max_iterations = 20,
          .max_cuts = 10,
          .patience = 4,
          .largest_correction = 0.1,
          .crossing_part = 1.0 / 16,
          .max_crossings = 8,
          .step_time = 1};
}

bool valid(const grainlaw_march_options& options) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  const auto not_negative = [](double value) { return value >= 0 && std::isfinite(value); };
  return positive(options.tolerance) && options.max_iterations >= 1 && options.max_cuts >= 0 &&
         options.max_cuts <= most_cuts && options.patience >= 1 &&
         not_negative(options.largest_correction) && not_negative(options.crossing_part) &&
         options.max_crossings >= 0 && not_negative(options.step_time);
}

double cut_ratio(double step_ratio) {
  if (!std::isfinite(step_ratio)) return stepping::largest_cut;
  return std::clamp(step_ratio, stepping::smallest_cut, stepping::largest_cut);
}

void March::begin(double from, double to) {
  from_ = done_ = from;
  to_ = to;
  length_ = to - from;
  crossings_ = 0;
  part_ = {};
  part_.residual = none;
  begin_attempt();
}

grainlaw_action March::next() {
  if (returned_) part_.keep = 0;
  if (returned_ && (action_ == GRAINLAW_ACCEPT || action_ == GRAINLAW_BACK))
    ends_part_ ? end_part() : begin_attempt();
  returned_ = true;
  return action_;
}

double March::bound(double largest_change) const {
  if (!std::isfinite(largest_change)) return 0;
  if (options_.largest_correction == 0) return 1;
  return std::min(1.0, options_.largest_correction / std::abs(largest_change));
}

void March::apply(double share) {
  whole_ = share == 1;
  part_.keep = 0;
  if (share == 0) fail(stepping::largest_cut, "the stiffness is singular");
}

void March::tell(const Told& told) {
  part_.keep = 0;
  part_.residual = told.found ? told.residual : none;
  if (action_ == GRAINLAW_CROSS) return judge_crossing(told);
  judge(told);
}

bool March::asks() const {
  return returned_ && (action_ == GRAINLAW_SOLVE || action_ == GRAINLAW_CROSS);
}

void March::begin_attempt() {
  const double next = done_ + length_;
  const bool ends = along(next) > along(to_) - stepping::rounding * whole() || from_ == to_;
  part_.load = ends ? to_ : next;
  part_.time = from_ == to_ ? 1 : (part_.load - done_) / (to_ - from_);
  part_.complete = part_.load == to_;
  part_.message[0] = '\0';
  iteration_ = best_iteration_ = 0;
  best_ = std::numeric_limits<double>::infinity();
  farthest_ = -1;
  whole_ = true;
  loaded_ = crossings_ > 0;  // all of it was applied before
  decide(GRAINLAW_SOLVE);
}

// The next part is longer.
void March::end_part() {
  if (part_.load == to_) return decide(GRAINLAW_DONE);
  length_ = stepping::growth * (part_.load - done_);
  done_ = part_.load;
  crossings_ = 0;
  begin_attempt();
}

void March::judge(const Told& told) {
  ++part_.solves;
  if (!told.found) return fail(told.step_ratio, told.reason);
  if (!std::isfinite(told.residual))
    return fail(stepping::largest_cut, "the residual is not finite");
  loaded_ = loaded_ || whole_;
  if (loaded_ && told.residual <= options_.tolerance) return accept(true);
  whole_ = true;
  if (loaded_ && told.unforeseen > farthest_) {
    farthest_ = told.unforeseen;
    part_.keep = 1;
  }
  if (told.residual < stepping::progress * best_) {
    best_ = told.residual;
    best_iteration_ = iteration_;
  }
  const bool stalled = iteration_ >= best_iteration_ + options_.patience;
  if (stalled || ++iteration_ >= options_.max_iterations)
    return end_without_convergence(told.residual);
  decide(GRAINLAW_SOLVE);
}

// In small parts, points whose P jumps are why. Shorter parts have the same rounding.
void March::end_without_convergence(double residual) {
  grainlaw_part text;
  const double best = std::min(best_, residual);
  if (loaded_ && options_.tolerance < stepping::noise && best <= stepping::noise) {
    write(text, "the tolerance is below rounding: residual %.1e, expected %.1e [-]; ask for %.0e",
          best, options_.tolerance, stepping::noise);
    return give_up(text.message);
  }
  const bool small = along(part_.load - done_) <= options_.crossing_part * whole();
  if (small && farthest_ >= 0 && options_.max_crossings > 0) return decide(GRAINLAW_CROSS);
  write(text, "Newton did not converge: best relative residual %.1e, expected %.1e [-]", best,
        options_.tolerance);
  fail(stepping::largest_cut, text.message);
}

void March::judge_crossing(const Told& told) {
  if (!told.found) return fail(stepping::largest_cut, told.reason);
  const bool beyond = crossings_ < options_.max_crossings;
  beyond_ = told.residual;
  if (!beyond && too_loose()) return give_up_beyond("too many jumps in one part");
  if (beyond) {
    ++crossings_;
    ++part_.crossed;
    part_.complete = 0;  // yet
  } else {
    ++part_.loose;
  }
  accept(!beyond);
}

void March::accept(bool ends_part) {
  ends_part_ = ends_part;
  decide(GRAINLAW_ACCEPT);
}

// Cuts the part. Not that of a state beyond a jump, which would go back: that state stays as it is.
void March::fail(double ratio, const char* reason) {
  ends_part_ = crossings_ > 0;
  if (ends_part_ && too_loose()) return give_up_beyond(reason);
  if (ends_part_) {
    ++part_.loose;
    write(part_, "%s", reason);
    return decide(GRAINLAW_BACK);
  }
  const double length = (part_.load - done_) * cut_ratio(ratio);
  if (from_ == to_ || along(length) < std::ldexp(whole(), -options_.max_cuts))
    return give_up(reason);
  ++part_.cuts;
  length_ = length;
  write(part_, "%s", reason);
  decide(GRAINLAW_BACK);
}

bool March::too_loose() const { return !(beyond_ <= stepping::largest_loose); }

void March::give_up_beyond(const char* reason) {
  grainlaw_part text;
  write(text, "beyond a jump the relative residual is %.1e, expected at most %g [-]: %.150s",
        beyond_, stepping::largest_loose, reason);
  give_up(text.message);
}

void March::give_up(const char* reason) {
  if (from_ == to_) {
    write(part_, "%s", reason);
  } else {
    const double along_it = 100 * (done_ - from_) / (to_ - from_);
    write(part_, "%.3g %% along, in parts of %.1e of it too: %.200s", along_it, part_.time, reason);
  }
  decide(GRAINLAW_GIVE_UP);
}

void March::decide(grainlaw_action action) {
  action_ = action;
  returned_ = false;
}

}  // namespace grainlaw::core
