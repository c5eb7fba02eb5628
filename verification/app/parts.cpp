#include "app/parts.hpp"

#include <cstdio>

namespace verification {

void Telling::refused(const Refusal& refusal) {
  status_ = refusal.status;
  grainlaw::PointsEvaluation told;
  told.status = status_ == GRAINLAW_OK ? GRAINLAW_NOT_CONVERGED : status_;
  told.summary.step_ratio = refusal.ratio;
  std::snprintf(told.summary.message, sizeof told.summary.message, "%s", refusal.reason.c_str());
  march_.tell(told, 0, 1);
}

namespace {

class Course {
 public:
  Course(const Step& step, StepMaker& maker) : step_(step), maker_(maker), done_(step.from) {}

  Parts make() {
    grainlaw_march_options options = step_.options;
    const bool loosely = step_.loose_tolerance > 0;
    if (loosely) options.max_crossings = 0;
    if (march(step_.from, options)) return parts_;
    std::string reason = std::exchange(failure_, "");
    if (loosely) {
      options.tolerance = step_.loose_tolerance;
      ++parts_.loose;
      if (march(step_.to, options)) return parts_;  // without a length: one attempt
      reason += "; with loose_tolerance: " + failure_;
    }
    throw StepError(status_,
                    fmt::format("{} failed{} {}", step_.name, whole() > 0 ? "" : ":", reason));
  }

 private:
  [[nodiscard]] double whole() const { return step_.to - step_.from; }

  // Marches to the end of the step; false: the march gave up.
  bool march(double from, const grainlaw_march_options& options) {
    grainlaw::March march(nullptr, options);
    Telling tell(march);
    march.begin(from, step_.to);
    int crossed = 0, loose = 0;
    for (bool begins = true;;) {
      const grainlaw_action now = march.next();
      const grainlaw_part& part = march.part();
      if (part.keep != 0) maker_.keep();
      if (now == GRAINLAW_SOLVE && std::exchange(begins, false)) begin(part.load);
      if (now == GRAINLAW_SOLVE) maker_.solve(tell);
      if (now == GRAINLAW_CROSS) maker_.cross(tell);
      const bool beyond = part.crossed > std::exchange(crossed, part.crossed);
      const bool left = part.loose > std::exchange(loose, part.loose);
      if (now == GRAINLAW_ACCEPT) maker_.accept(beyond);
      if (now == GRAINLAW_BACK || now == GRAINLAW_GIVE_UP) {
        maker_.back(left);
        failure_ = part.message;
        status_ = tell.take_status();
      }
      begins = begins || now == GRAINLAW_ACCEPT || now == GRAINLAW_BACK;
      if (left || (now == GRAINLAW_ACCEPT && !beyond)) done_ = part.load;
      if (now != GRAINLAW_DONE && now != GRAINLAW_GIVE_UP) continue;
      parts_.solves += part.solves;
      parts_.cuts += part.cuts + (now == GRAINLAW_GIVE_UP ? 1 : 0);
      parts_.crossed += part.crossed;
      parts_.loose += part.loose;
      return now == GRAINLAW_DONE;
    }
  }

  void begin(double load) {
    if (!failure_.empty() && whole() > 0 && step_.observe_cut)
      step_.observe_cut((load - done_) / whole(), std::exchange(failure_, ""));
    maker_.begin(load, load - done_);
  }

  const Step& step_;
  StepMaker& maker_;
  Parts parts_;
  double done_;          // the last load in balance
  std::string failure_;  // of the last attempt that failed
  grainlaw_status status_ = GRAINLAW_OK;
};

class ByAttempts final : public StepMaker {
 public:
  explicit ByAttempts(const PartAttempt& attempt) : attempt_(attempt) {}

  void begin(double load, double length) override { load_ = load, length_ = length; }
  void solve(Telling& tell) override {
    if (const auto refusal = attempt_(load_, length_))
      tell.refused(*refusal);
    else
      tell.found(0);
  }
  void keep() override {}
  void cross(Telling&) override {}
  void accept(bool) override {}
  void back(bool) override {}

 private:
  const PartAttempt& attempt_;
  double load_ = 0, length_ = 0;
};

}  // namespace

Parts make_step(const Step& step, StepMaker& maker) { return Course(step, maker).make(); }

Parts make_step(const Step& step, const PartAttempt& attempt) {
  ByAttempts maker(attempt);
  return make_step(step, maker);
}

}  // namespace verification
