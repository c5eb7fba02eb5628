// What the three solvers of a finite element model have in common.
#pragma once

#include "app/parts.hpp"
#include "fe/checkpoint.hpp"
#include "fe/model.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace verification {

// Energies of a dynamic run since its start, per metre of thickness [J/m]. Their balance, kinetic +
// internal + damped - external, vanishes with the time step.
struct Energies {
  double kinetic = 0;
  double internal = 0;  // work of the stresses, stored or dissipated by the packings
  double external = 0;  // work of loads and supports
  double damped = 0;    // work against the viscous damping

  [[nodiscard]] double balance() const { return kinetic + internal + damped - external; }
};

// One solved load step. Residuals: of every attempt one after the other; entry 0 of an attempt is
// the imbalance after the load increment, entry k the one after k corrections.
struct LoadStep {
  Record record;  // means over the integration points
  double time = 0;
  std::vector<double> residuals;
  std::vector<std::size_t> attempts;  // entry of the first residual of each
  double balance = 0;  // of static solvers: largest residual that a part of the step ended at [-]
  // Of every monitor of the model: how far it has moved [m], and the force on its nodes [N/m].
  std::vector<double> displacements;
  std::vector<double> reactions;
  std::optional<Energies> energies;  // of dynamic runs
};

// A model on its way through a run: everything up to the committed time is done.
class Solver {
 public:
  Solver() = default;
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // From the committed time to this one (at time 0: brings the loads of time 0 to equilibrium), in
  // as many parts as it takes. Throws ComputationError, saying where, when that is not possible.
  virtual LoadStep advance(double to, int number) = 0;

  // How long a load step is, the unit of the time steps that static solvers tell their points: its
  // parts are the shorter for them. Dynamics tells seconds.
  void set_load_step(double length) { load_step_ = length; }

  // Of the load steps that static solvers make in parts.
  void observe_cuts(CutObserver observer) { observe_cut_ = std::move(observer); }

  // Everything that the next `advance` depends on, between two calls of it: a solver of the same
  // scene that restores it goes on to the same bits. Throws as CheckpointReader does.
  virtual void save(CheckpointWriter& out) const = 0;
  virtual void restore(CheckpointReader& in) = 0;

  [[nodiscard]] virtual const PointField& points() const = 0;
  [[nodiscard]] virtual const Eigen::VectorXd& displacement() const = 0;  // committed [m]

 protected:
  // Time of a part as its points are told it; one load step where time stands still.
  [[nodiscard]] double told_time(double part) const { return part > 0 ? part / load_step_ : 1; }

  CutObserver observe_cut_;

 private:
  double load_step_ = 1;
};

using LoadObserver = std::function<void(const LoadStep&, const Solver&)>;

// Step 0 brings the loads at time 0 to equilibrium; steps 1..steps divide the duration evenly.
// Stops after step `last`; a restored solver goes on with the step after the one it was saved at.
void run_load_steps(Solver& solver, double duration, int steps, int last,
                    const LoadObserver& observe, int first = 0);

}  // namespace verification
