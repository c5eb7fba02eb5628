// Materials and states of either dimension behind one type.
#pragma once

#include "state/serialise.hpp"
#include "state/state.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace grainlaw::core {

using AnyMaterial =
    std::variant<std::shared_ptr<const Material<2>>, std::shared_ptr<const Material<3>>>;

// make_material() in the dimension of the description.
AnyMaterial make_any_material(MaterialDescription description);

using SavedState = std::variant<SavedStateOf<2>, SavedStateOf<3>>;
using SavedTrial = std::variant<SavedTrialOf<2>, SavedTrialOf<3>>;

class AnyState {
 public:
  explicit AnyState(const AnyMaterial& material);
  AnyState(const AnyState& other);
  AnyState(AnyState&& other) noexcept;
  AnyState& operator=(AnyState&& other) noexcept;
  ~AnyState();

  [[nodiscard]] int dimension() const { return state_.index() == 0 ? 2 : 3; }
  [[nodiscard]] bool shares_material(const AnyState& other) const;

  // Throws Error (NOT_FINITE, INVERTED; STEP_TOO_LARGE when the determinant overflows) for an F
  // that no packing can follow. Found components do not count.
  void check_deformation(const double* F) const;

  // Evaluates as State::evaluate() does.
  grainlaw_status evaluate(const double* F, TangentKind kind, double* P, double* A,
                           grainlaw_report& report);
  void set_time_step(double step);
  [[nodiscard]] double time_step() const;
  bool commit();
  void revert();
  [[nodiscard]] bool has_trial() const;
  [[nodiscard]] std::vector<double> committed_deformation() const;  // F [dim*dim]
  void committed_stress(double* P) const;                           // [dim*dim] [Pa]
  // Squared norm of what a tangent of the committed state leaves of the change of P to the trial
  // [Pa^2]; 0 without a trial.
  [[nodiscard]] double unforeseen(std::span<const double> tangent) const;

  // Writes the committed state to saved_size() bytes.
  [[nodiscard]] std::size_t saved_size() const;
  void save(std::span<std::byte> bytes) const;
  [[nodiscard]] SavedState read(std::span<const std::byte> bytes) const;
  // Makes a loaded state the committed one and drops the trial.
  void restore(SavedState saved) noexcept;
  // The trial likewise, as State's.
  [[nodiscard]] std::size_t saved_trial_size(bool evaluated) const;
  void save_trial(bool evaluated, std::span<std::byte> bytes) const;
  [[nodiscard]] SavedTrial read_trial(std::span<const std::byte> bytes) const;
  void restore(SavedTrial saved) noexcept;

  // Calls `act` with the state of its dimension.
  template <class Act>
  auto visit(Act&& act) {
    return std::visit(std::forward<Act>(act), state_);
  }
  template <class Act>
  auto visit(Act&& act) const {
    return std::visit(std::forward<Act>(act), state_);
  }

  // Measure of the trial, or of the committed state without one.
  void measure(grainlaw_measure what, double* value) const;
  [[nodiscard]] std::vector<grainlaw_particle> particles() const;
  [[nodiscard]] std::vector<grainlaw_contact> contacts() const;
  void write_force_chains(const std::string& path) const;
  void write_packing(const std::string& prefix) const;

 private:
  std::variant<State<2>, State<3>> state_;
};

}  // namespace grainlaw::core
