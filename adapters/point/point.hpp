// One integration point of a host that never says commit. Its committed state is the outcome of the
// last increment which the host went on from; the trial is what was answered since.
#pragma once

#include "stress_tangent.hpp"

#include <grainlaw/grainlaw.hpp>

#include <mutex>
#include <string>

namespace grainlaw::adapters {

struct Answer {
  grainlaw_status status = GRAINLAW_OK;  // OK, or recoverable
  grainlaw_report report = grainlaw_report_default();
  bool approximate = false;  // found, but with friction history advanced on the way
};

class Point {
 public:
  explicit Point(const grainlaw::Material& material);

  // How far two deformation gradients are apart: largest difference of a component.
  static double distance(const Tensor2& F, const Tensor2& other);

  [[nodiscard]] const Tensor2& committed() const { return committed_; }  // F of the last commit
  [[nodiscard]] bool is_trial(const Tensor2& F) const;  // F of the trial, to rounding

  // How long increments from now on take, 0 where that is not known: a law in time then refuses to deform.
  void set_time_step(double step) { state_.set_time_step(step); }

  // P and, when wanted, dP/dF at F, from the committed state. Throws std::runtime_error with a text
  // for the host when F is not finite or not plane strain, grainlaw::StatusError for the library's own.
  Answer evaluate(const Tensor2& F, unsigned want, Response& response);

  // Evaluates for a host that takes S, Cauchy stress or a tangent of theirs: also throws, and forgets
  // the trial, where F^-1 P is not symmetric up to what is out of balance.
  Answer evaluate_symmetric(const Tensor2& F, unsigned want, Response& response);

  // The host went on from F: commit the trial there. Where it is no longer at hand it is found again from
  // the committed state, F and the time step. Throws when no equilibrium is found.
  void accept(const Tensor2& F);

  // Forget the trial.
  void revert();

  // About the memory of the state, committed and trial.
  [[nodiscard]] std::size_t bytes() const;

  // Held by the caller that works on the point.
  std::mutex in_use;

 private:
  grainlaw::State state_;
  int dimension_;
  Tensor2 committed_ = identity;
  Tensor2 trial_{};
  bool has_trial_ = false;
};

// The time step that a host tells; 0 where it tells none.
double time_step_of(double told);

// "F12" for index 1.
std::string component_name(int index);

}  // namespace grainlaw::adapters
