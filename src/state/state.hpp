// One integration point: the committed equilibrium, and the trial of the last F.
#pragma once

#include "material/material.hpp"
#include "state/reference.hpp"
#include "state/serialise.hpp"
#include "state/serialise_trial.hpp"
#include "state/time_step.hpp"

#include <grainlaw/grainlaw.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace grainlaw::core {

template <int D>
struct Request;
template <int D>
struct SplitIncrement;
template <int D>
struct Workspace;
struct Outcome;

// P and dP/dF of one evaluation.
template <int D>
struct Answer {
  Tensor<D> stress{};
  Tensor4<D> tangent{};
};

enum class TangentKind { none, exact, elastic, perturbed };

template <int D>
class State {
 public:
  static constexpr int dim = D;

  explicit State(std::shared_ptr<const Material<D>> material);

  // Finds the equilibrium at F (dim x dim row-major, finite, det F > 0) from the committed state
  // and keeps it as the trial. P [dim*dim] and A [dim^4] [Pa] may be null; both and the trial are
  // written on success only. The report covers the work until a failure too. Throws bad_alloc, and
  // Error (NOT_CONVERGED) when an iterate leaves the range of the neighbour search.
  grainlaw_status evaluate(const double* F, TangentKind kind, double* P, double* A,
                           grainlaw_report& report);

  // Evaluates at the packing's own F, whatever the reference; P and A are of it. `duration` [memories]
  // replaces the time that the host told.
  grainlaw_status follow(const Tensor<D>& F, std::optional<double> duration, TangentKind kind,
                         Answer<D>& answer, grainlaw_report& report);

  // Makes the committed state, at rest, the one at F = I, from which losses and rotations count.
  void set_reference_here();
  [[nodiscard]] const std::optional<Reference<D>>& reference() const { return reference_; }
  // F and P [Pa] of the host there.
  [[nodiscard]] Tensor<D> deformation_of_host(const Configuration<D>& there) const;
  [[nodiscard]] Tensor<D> stress_of_host(const Configuration<D>& there) const;
  // Squared norm of the change of P to the trial that the tangent does not explain [Pa^2].
  [[nodiscard]] double unforeseen(std::span<const double> tangent) const;
  // Measure of the trial, or of the committed state without one.
  void measure(grainlaw_measure what, double* value) const;

  // F with its found components replaced by the committed ones.
  [[nodiscard]] Tensor<D> effective(const double* F) const;

  // Sets the time of the following increments, in the host's unit; 0: none.
  void set_time_step(double step) { time_step_ = step; }
  [[nodiscard]] double time_step() const { return time_step_; }

  bool commit();  // returns false without a trial
  void revert() { has_trial_ = false; }
  [[nodiscard]] bool has_trial() const { return has_trial_; }
  [[nodiscard]] const Configuration<D>& committed() const { return committed_; }
  [[nodiscard]] const Configuration<D>& current() const { return has_trial_ ? trial_ : committed_; }
  void restore(SavedStateOf<D> saved);
  void restore(Configuration<D> committed);  // of the packing's reference
  [[nodiscard]] const Material<D>& material() const { return *material_; }

  // The trial as bytes, of which there are saved_trial_size(). Unless `evaluated`, only what the next
  // trial starts from.
  [[nodiscard]] std::size_t saved_trial_size(bool evaluated) const;
  void save_trial(bool evaluated, std::span<std::byte> bytes) const;
  // Reads any bytes of any length. Throws Error (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL).
  [[nodiscard]] SavedTrialOf<D> read_trial(std::span<const std::byte> bytes) const;
  // Makes a trial found elsewhere, from the same committed state, that of this one.
  void restore(SavedTrialOf<D> saved) noexcept;

 private:
  grainlaw_status follow(const Tensor<D>& F, std::optional<double> duration, TangentKind kind,
                         Answer<D>& answer, grainlaw_report& report, Workspace<D>& workspace);
  [[nodiscard]] Request<D> request_of(const Problem<D>& problem, const SplitIncrement<D>& split,
                                      TangentKind kind, double duration, bool had_trial,
                                      Workspace<D>& workspace) const;
  grainlaw_status answer_of(const Outcome& outcome, TangentKind kind, const Workspace<D>& workspace,
                            Answer<D>& answer, grainlaw_report& report) const;
  void keep_trial(const Outcome& outcome, Workspace<D>& workspace, grainlaw_report& report);
  void rotate_back(const SplitIncrement<D>& split, const Tensor<D>& F, bool tangent_wanted,
                   Answer<D>& answer);
  [[nodiscard]] bool keeps_trial(bool evaluated) const;

  std::shared_ptr<const Material<D>> material_;
  std::optional<Reference<D>> reference_;  // none: that of the packing
  Configuration<D> committed_;
  Configuration<D> trial_;
  bool has_trial_ = false;
  double time_step_ = untold;
  bool trial_loose_ = false;     // converged to the loose tolerance
  bool trial_advanced_ = false;  // found by advancing history
  // Fluctuations of the trial by F: a column of nodes, component-major, for each lane of
  // ByDeformation. Kept where increments start from trials; empty: unknown.
  std::vector<float> trial_slopes_;
};

}  // namespace grainlaw::core
