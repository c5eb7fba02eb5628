#include "equilibrium/newton.hpp"

#include "base/constants.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Residual that the flow does not explain: sqrt(sum (r - a m dz)^2 / m).
template <int D>
double defect_norm(const Increment<D>& increment, std::span<const double> step, double a) {
  const double* r = increment.residual().data();
  const double* m = increment.masses().of_unknowns().data();
  double sum = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double value = r[k] - a * m[k] * step[k];
    sum += value * value / m[k];
  }
  return std::sqrt(sum);
}

// Largest displacement of a particle's surface, relative to its neighbours where F is found [m].
template <int D>
double largest_displacement(const Increment<D>& increment, std::span<const double> step) {
  const auto nodes = increment.problem().nodes();
  double largest = 0;
  for (std::size_t k = increment.problem().node_unknowns(); k < step.size(); ++k) {
    const double lever = increment.motion().mean_branch() / increment.motion().deformation_scale();
    largest = std::max(largest, std::abs(step[k]) * lever);
  }
  for (std::size_t k = 0; k < increment.problem().node_unknowns(); ++k) {
    const double lever = k < D * nodes ? 1.0 : increment.motion().node_radius()[k % nodes];
    largest = std::max(largest, std::abs(step[k]) * lever);
  }
  return largest;
}

template <int D>
class PseudoTransientNewton {
 public:
  PseudoTransientNewton(Increment<D>& increment, double tolerance, NewtonMemory<D>& memory,
                        RelaxationMemory<D>* relaxation)
      : increment_(increment),
        tolerance_(tolerance),
        memory_(memory),
        relaxation_(relaxation),
        may_roll_(RollingMechanisms<D>::possible(increment.problem()) &&
                  !increment.motion().drag().acts()) {
    memory.step.assign(increment.problem().unknowns(), 0.0);
    const auto& z = increment.motion().coordinates();
    for (auto* positions : {&memory.coordinates, &memory.shifted}) positions->reserve(z.size());
    for (auto* moves : {&memory.flow, &memory.total}) moves->reserve(memory.step.size());
    increment.refresh_masses();
    if (may_roll_) memory.mechanisms.forget(increment);
    if (increment.add_chord_springs()) increment.update_forces();
    keep_best();
  }
  ~PseudoTransientNewton() { increment_.remove_chord_springs(); }

  bool run(int max_factorisations) {
    const int last = increment_.cost.factorisations + max_factorisations;
    while (increment_.cost.factorisations < last && std::isfinite(norm_)) {
      if (increment_.residual_norm() < tolerance_) return true;
      assemble();
      if (may_roll_) {
        rotate_mechanisms();
        if (increment_.residual_norm() < tolerance_) return true;
        memory_.mechanisms.regularise(increment_, memory_.stiffness);
      }
      memory_.residual.assign(increment_.residual().begin(), increment_.residual().end());
      const bool solved = solve();
      if (solved && may_roll_) memory_.mechanisms.see(increment_, memory_.step, least_moment());
      if (!solved) {
        if (!raise_shift()) return false;
      } else if (full_steps_) {
        full_step();
      } else if (!flow_step()) {
        return false;
      }
    }
    return increment_.residual_norm() < tolerance_;
  }

 private:
  [[nodiscard]] double defect() const { return defect_norm(increment_, memory_.step, 0); }
  void assemble() { memory_.stiffness.assemble(increment_, shift_); }

  // Least moment of a mechanism that counts, over the radius [N].
  [[nodiscard]] double least_moment() const {
    return tuned::least_moment * tolerance_ * increment_.scale().relative();
  }

  void rotate_mechanisms() {
    auto& mechanisms = memory_.mechanisms;
    mechanisms.find(increment_, memory_.stiffness.touching());
    if (!mechanisms.rotate(increment_, least_moment())) return;
    increment_.update_forces();
    norm_ = defect();
    if (norm_ < best_) keep_best();
    assemble();
    mechanisms.find(increment_, memory_.stiffness.touching());
  }

  // Share of the residual that a linear solve may leave, from the convergence of Newton's method.
  [[nodiscard]] double forcing() {
    if constexpr (D == 2) return 0;
    const double ratio = full_steps_ && last_norm_ > 0 ? norm_ / last_norm_ : 1;
    last_norm_ = norm_;
    const double least = tuned::share_of_tolerance * tolerance_ / increment_.residual_norm();
    return std::min(std::max(ratio * ratio, least), tuned::loose_step);
  }

  // Solves for memory_.step with the matrix assembled at the present coordinates.
  bool solve() {
    auto& stiffness = memory_.stiffness;
    const auto& residual = memory_.residual;
    auto& step = memory_.step;
    if constexpr (D == 2) {
      if (BorderedSystem::needed(*increment_.problem().space)) {
        stiffness.factorise(increment_);
        return memory_.border.solve(increment_, stiffness, shift_, residual, step);
      }
    }
    return stiffness.solve_step(increment_, residual, forcing(), step);
  }

  void keep_best() {
    norm_ = best_ = defect();
    memory_.best = increment_.motion().coordinates();
    best_deformation_ = increment_.motion().deformation();
    without_gain_ = 0;
  }

  void go_to(const std::vector<double>& coordinates, const Tensor<D>& deformation) {
    increment_.motion().go_to(coordinates, deformation);
    increment_.keep_neighbours();
    increment_.update_forces();
  }

  bool raise_shift() {
    shift_ = std::max(4 * shift_, tuned::first_shift);
    return shift_ <= tuned::largest_shift;
  }

  // True if the residual after a step suggests a relaxation.
  [[nodiscard]] bool may_settle(double after, double before) const {
    return relaxation_ != nullptr && after > tuned::good_step * before &&
           after < tuned::largest_rise * before;
  }

  // Relaxes briefly, to balance forces around single contacts.
  void settle() {
    relax(increment_, tolerance_, tuned::settling_steps, History::committed, *relaxation_);
  }

  // Takes a Newton step of limited length: longer ones exchange contacts. Where the limit leaves
  // too little of it, the shift rises instead.
  void full_step() {
    const double before = norm_;
    const double limit = tuned::longest_full_step * increment_.scale().relative() /
                         increment_.masses().mean_stiffness();
    const double share = limit / largest_displacement(increment_, memory_.step);
    if (share < tuned::least_share && shift_ < tuned::flow_shift) {
      shift_ = std::max(16 * shift_, tuned::first_shift);
      return;
    }
    increment_.motion().move(memory_.step, std::min(1.0, share));
    increment_.keep_neighbours();
    increment_.update_forces();
    increment_.refresh_masses();
    norm_ = defect();
    if (may_settle(norm_, best_)) {
      settle();
      increment_.refresh_masses();
      norm_ = defect();
    }
    if (norm_ < tuned::acceptable_step * best_) {
      keep_best();
      shift_ = shift_ / 16 < tuned::least_shift ? 0 : shift_ / 16;
    } else if (++without_gain_ == tuned::full_step_patience ||
               !(norm_ < tuned::largest_rise * best_) ||
               std::abs(norm_ - before) < tuned::no_change * before) {
      go_to(memory_.best, best_deformation_);
      increment_.refresh_masses();
      norm_ = best_;
      full_steps_ = false;
      shift_ = tuned::flow_shift;
    }
  }

  // Share of memory_.step that keeps particles near their positions [-].
  [[nodiscard]] double near_share() const {
    const auto radius = increment_.motion().node_radius();
    const double smallest = *std::min_element(radius.begin(), radius.end());
    return std::min(
        1.0, tuned::longest_flow_step * smallest / largest_displacement(increment_, memory_.step));
  }

  void move(double fraction) {
    increment_.motion().move(memory_.step, fraction);
    increment_.keep_neighbours();
    increment_.update_forces();
  }

  // Takes an implicit Euler step of the overdamped flow, shift_ m dz = r(z + dz). Where contacts
  // change status the step is settled, corrected or at last shortened.
  bool flow_step() {
    memory_.coordinates = increment_.motion().coordinates();
    memory_.flow = memory_.step;
    const auto deformation = increment_.motion().deformation();
    const double cap = near_share();
    double fraction = cap;
    for (int shortening = 0; shortening < 3; ++shortening, fraction *= 0.3) {
      if (shortening > 0) {
        increment_.motion().go_to(memory_.coordinates, deformation);
        memory_.step = memory_.flow;
      }
      move(fraction);
      const double error = defect_norm(increment_, memory_.step, fraction * shift_);
      // A shortened step promises only its share of the decrease.
      const bool found = error < (1 - fraction * (1 - tuned::acceptable_step)) * norm_;
      if (!found && !(fraction == 1 && (settled(error) || corrected(error)))) continue;
      if (fraction == 1) shift_ /= error < tuned::good_step * norm_ ? 16 : 4;
      if (fraction < cap) shift_ *= 4;
      if (shift_ < tuned::least_shift) shift_ = 0;
      increment_.refresh_masses();
      norm_ = defect();
      if (norm_ < tuned::sufficient_gain * best_) {
        full_steps_ = true;
        keep_best();
      }
      return true;
    }
    go_to(memory_.coordinates, deformation);
    return raise_shift();
  }

  // Relaxes after a step; undoes that unless the residual falls below its value before the step.
  bool settled(double error) {
    if (!may_settle(error, norm_)) return false;
    memory_.shifted = increment_.motion().coordinates();
    const auto deformation = increment_.motion().deformation();
    settle();
    if (defect() < tuned::acceptable_step * norm_) return true;
    go_to(memory_.shifted, deformation);
    return false;
  }

  // Applies Newton's method to the equation of the implicit step, after its first iteration.
  bool corrected(double error) {
    memory_.total = memory_.flow;
    for (int k = 0; k < tuned::most_corrections && error < tuned::diverging_correction * norm_;
         ++k) {
      const double* r = increment_.residual().data();
      const double* m = increment_.masses().of_unknowns().data();
      for (std::size_t q = 0; q < memory_.total.size(); ++q) {
        memory_.residual[q] = r[q] - shift_ * m[q] * memory_.total[q];
      }
      assemble();
      if (!solve() || near_share() < 1) return false;
      for (std::size_t q = 0; q < memory_.total.size(); ++q) memory_.total[q] += memory_.step[q];
      move(1);
      error = defect_norm(increment_, memory_.total, shift_);
      if (error < tuned::acceptable_step * norm_) return true;
    }
    return false;
  }

  Increment<D>& increment_;
  double tolerance_;
  NewtonMemory<D>& memory_;
  RelaxationMemory<D>* relaxation_;  // null: none
  bool may_roll_;                    // rolling mechanisms are possible
  double shift_ = tuned::first_shift;
  double norm_ = 0;       // of the residual at the present coordinates
  double last_norm_ = 0;  // before the last step; 0: no step yet
  double best_ = 0;       // least norm so far, at memory_.best
  Tensor<D> best_deformation_{};
  int without_gain_ = 0;
  bool full_steps_ = true;
};

}  // namespace

template <int D>
bool pseudo_transient_newton(Increment<D>& increment, double tolerance, int max_factorisations,
                             NewtonMemory<D>& memory, RelaxationMemory<D>* relaxation) {
  return PseudoTransientNewton<D>(increment, tolerance, memory, relaxation).run(max_factorisations);
}

#define GRAINLAW_FOR(D)                                                               \
  template bool pseudo_transient_newton(Increment<D>&, double, int, NewtonMemory<D>&, \
                                        RelaxationMemory<D>*);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
