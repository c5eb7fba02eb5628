#include "point/laboratory_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace verification {
namespace {

constexpr int most_legs = 100000;

// One test in progress; `way` is the driving strain, axial or shear, since its start.
template <int D>
class Course {
 public:
  Course(PointDriverOf<D>& driver, const ElementTest& test, const PointObserverOf<D>& observe,
         const CutObserver& observe_cut)
      : driver_(driver),
        test_(test),
        observe_(observe),
        observe_cut_(observe_cut),
        start_(driver.record().deformation),
        sigma_(driver.record().cauchy),
        p_(pressure()),
        q_(deviator()) {}

  TestEnd run() {
    try {
      if (test_.led_by_stress())
        lead_by_stress();
      else if (test_.cycles == 0)
        lead(test_.end);
      else
        loop();
    } catch (const StepError& error) {
      constexpr double weak = 0.1;  // share of the initial pressure that no longer bears load
      if (!(test_.stop.liquefied > 0) || pressure() > weak * p_) throw;
      end_ = {fmt::format(
                  "liquefied: no equilibrium after a mean pressure of {:.4g} Pa, {:.2g} of that at "
                  "the start",
                  pressure(), pressure() / p_),
              true};
    }
    return end_;
  }

 private:
  static constexpr int axial = D * D - 1;  // the component DD
  static constexpr int sheared = D - 1;    // the component 1D

  [[nodiscard]] const RecordOf<D>& record() const { return driver_.record(); }
  [[nodiscard]] double pressure() const { return record().mean_pressure(); }
  [[nodiscard]] double deviator(const RecordOf<D>& at) const {
    return test_.shear() ? at.cauchy(0, D - 1) : at.deviatoric_stress();
  }
  [[nodiscard]] double deviator() const { return deviator(record()); }

  // Reason to stop after a step; "" to continue.
  [[nodiscard]] TestEnd stopped(const RecordOf<D>& before) const {
    const TestStop& stop = test_.stop;
    const auto passed = [](double from, double to, double wanted) {
      return (from - wanted) * (to - wanted) <= 0;
    };
    const double p = pressure(), q = std::abs(deviator());
    const double strain = test_.led_by_stress()
                              ? 1 - record().deformation(D - 1, D - 1) / start_(D - 1, D - 1)
                              : way_;
    if (stop.liquefied > 0 && p < stop.liquefied * p_)
      return {
          fmt::format("liquefied: mean pressure {:.4g} Pa, {:.2g} of that at the start", p, p / p_),
          true};
    if (stop.strain && std::abs(strain) >= *stop.strain * (1 - 1e-9))
      return {fmt::format("strain {:.6g} reached", strain), false};
    if (stop.q && q >= *stop.q) return {fmt::format("q {:.6g} Pa reached", q), false};
    if (stop.ratio && q >= *stop.ratio * p)
      return {fmt::format("q/p {:.6g} reached", q / p), false};
    if (stop.p && passed(before.mean_pressure(), p, *stop.p))
      return {fmt::format("mean pressure {:.6g} Pa reached", p), false};
    if (stop.axial_stress &&
        passed(before.axial_stress(), record().axial_stress(), *stop.axial_stress))
      return {fmt::format("axial stress {:.6g} Pa reached", record().axial_stress()), false};
    return {};
  }

  // The step to a driving strain, or to a share of a stress.
  [[nodiscard]] Segment step_to(double way, double pressure) const {
    Segment step;
    const auto stress = [&](int k, double value) {
      step.target[static_cast<std::size_t>(k)] = {Control::cauchy, false, value};
    };
    const int laterals = D - 1;
    if (test_.kind == TestKind::isotropic) {
      for (int i = 0; i < D; ++i)
        stress((D + 1) * i, sigma_(i, i) + way * (-pressure - sigma_(i, i)));
      return step;
    }
    if (test_.kind == TestKind::k0) {
      stress(axial, sigma_(D - 1, D - 1) + way * (-pressure - sigma_(D - 1, D - 1)));
      return step;
    }
    if (test_.shear())
      step.target[sheared] = {Control::deformation, false,
                              start_(0, D - 1) + way * start_(D - 1, D - 1)};
    else
      step.target[axial] = {Control::deformation, false, start_(D - 1, D - 1) * (1 - way)};
    for (int i = 0; i < laterals; ++i) {
      const int k = (D + 1) * i;
      if (test_.kind == TestKind::drained) stress(k, test_.held ? -*test_.held : sigma_(i, i));
      if (test_.kind == TestKind::undrained) step.keeps_volume[static_cast<std::size_t>(i)] = true;
      if (test_.kind == TestKind::constant_p)
        step.target[static_cast<std::size_t>(k)] =
            i == 0 ? Target{Control::mean, false, -p_}
                   : Target{Control::difference, false, sigma_(i, i) - sigma_(0, 0), 0};
    }
    if (test_.kind == TestKind::undrained) step.volume = start_.determinant();
    if (test_.b) {
      constexpr std::size_t intermediate = 1;
      step.target[(D + 1) * intermediate] = {Control::difference, false, 0, 0, *test_.b};
      step.keeps_volume[intermediate] = false;
    }
    if (test_.kind == TestKind::shear_pressure)
      stress(axial, test_.held ? -*test_.held : sigma_(D - 1, D - 1));
    return step;
  }

  // Makes a step; returns false when it was taken back.
  bool make(double way, double pressure = 0, const PointJudgeOf<D>& may_stay = {}) {
    const RecordOf<D> before = record();
    if (!driver_.run_steps(step_to(way, pressure), observe_, observe_cut_, may_stay)) return false;
    way_ = way;
    end_ = stopped(before);
    return true;
  }

  [[nodiscard]] bool over() const { return !end_.text.empty() || driver_.left(); }

  // Drives to a strain in equal steps.
  bool lead(double to) {
    const double from = way_;
    const int count =
        std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / test_.step - 1e-9)));
    for (int k = 1; k <= count && !over(); ++k)
      make(k == count ? to : from + (to - from) * k / count);
    return !over();
  }

  // Drives in this direction until q reaches the wanted value: whole steps, and a last one as long as
  // it takes.
  bool lead_to_q(double wanted, double direction) {
    constexpr double close = 1e-6;                  // of the amplitude
    const auto rest = [&](const RecordOf<D>& at) {  // of the amplitude [-]
      return direction * (wanted - deviator(at)) / test_.amplitude;
    };
    for (int k = 0; k < most_legs; ++k) {
      if (rest(record()) <= close) return true;
      step_towards(rest, close, direction);
      if (over()) return false;
      if (std::abs(way_) > std::abs(test_.end)) {
        end_ = {fmt::format("strain {:.4g} reached before q {:.4g} Pa", way_, wanted), false};
        return false;
      }
    }
    return false;
  }

  // A whole step, or the share of it where nothing is left, by regula falsi (Illinois). Where q jumps
  // over the goal, the least share that does.
  template <class Rest>
  void step_towards(const Rest& rest, double close, double direction) {
    constexpr double least = 1e-10;  // of a step, between two shares
    const double from = way_;
    double share = 1, low = 0, left_at_low = rest(record()), high = 1, left_at_high = 0, left = 0;
    bool jump = false;
    const auto may_stay = [&](const RecordOf<D>& at) {
      const double previous = std::exchange(left, rest(at));
      if (jump || std::abs(left) <= close || (share == 1 && left > 0)) return true;
      const bool again = previous * left > 0;  // on the same side: the other end is stale
      (left > 0 ? low : high) = share;
      (left > 0 ? left_at_low : left_at_high) = left;
      if (again) (left > 0 ? left_at_high : left_at_low) /= 2;
      return false;
    };
    while (!make(from + direction * share * test_.step, 0, may_stay)) {
      jump = high - low < least;
      share =
          jump ? high : (low * left_at_high - high * left_at_low) / (left_at_high - left_at_low);
    }
    if (jump) ++jumps_;
  }

  void loop() {
    for (int k = 0; k < test_.cycles; ++k)
      for (const double side : {1.0, -1.0}) {
        const bool on = test_.amplitude_of_q ? lead_to_q(q_ + side * test_.amplitude, side)
                                             : lead(side * test_.amplitude);
        if (!on) {
          if (!end_.text.empty())
            end_.text += fmt::format(", in loop {} of {}", k + 1, test_.cycles);
          return;
        }
      }
    if (!test_.amplitude_of_q)
      lead(0);
    else if (lead_to_q(q_, 1) && jumps_ > 0)
      end_.text = fmt::format("q jumped past its amplitude at {} of {} turns", jumps_,
                              2 * test_.cycles + 1);
  }

  void lead_by_stress() {
    const double now = test_.kind == TestKind::isotropic ? p_ : record().axial_stress();
    const double end = test_.end > 0 ? test_.end : 2 * now;
    const auto count = static_cast<int>(std::lround(1 / test_.step));
    for (int leg = 0; leg < std::max(1, 2 * test_.cycles); ++leg)
      for (int k = 1; k <= count; ++k) {
        const double share = static_cast<double>(k) / count;
        make(leg % 2 == 0 ? share : 1 - share, end);
        if (over()) return;
      }
  }

  PointDriverOf<D>& driver_;
  const ElementTest& test_;
  const PointObserverOf<D>& observe_;
  const CutObserver& observe_cut_;
  const TensorOf<D> start_, sigma_;
  const double p_, q_;
  double way_ = 0;
  int jumps_ = 0;  // of q over an amplitude
  TestEnd end_;
};

}  // namespace

template <int D>
TestEnd run_element_test(PointDriverOf<D>& driver, const ElementTest& test,
                         const PointObserverOf<D>& observe, const CutObserver& observe_cut) {
  return Course<D>(driver, test, observe, observe_cut).run();
}

template TestEnd run_element_test<2>(PointDriverOf<2>&, const ElementTest&,
                                     const PointObserverOf<2>&, const CutObserver&);
template TestEnd run_element_test<3>(PointDriverOf<3>&, const ElementTest&,
                                     const PointObserverOf<3>&, const CutObserver&);

}  // namespace verification
