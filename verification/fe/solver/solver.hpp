// Common interface of the three solvers of a finite element model.
#pragma once

#include "app/parts.hpp"
#include "fe/body_record.hpp"
#include "fe/checkpoint.hpp"
#include "fe/model.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace verification {

// Energies of a dynamic run since its start, in the plane per metre of thickness [J/m], of
// solids [J]. Their balance, kinetic +
// internal + damped - external, vanishes with the time step.
struct Energies {
  double kinetic = 0;
  double internal = 0;  // work of the stresses, stored or dissipated by the packings
  double external = 0;  // work of loads and supports
  double damped = 0;    // work against the viscous damping

  [[nodiscard]] double balance() const { return kinetic + internal + damped - external; }
};

// One solved load step. `residuals` has those of all attempts: the first of an attempt is the
// imbalance after the load increment, entry k that after k corrections.
struct LoadStep {
  BodyRecord record;  // means over the integration points
  double time = 0;
  std::vector<double> residuals;
  std::vector<std::size_t> attempts;  // index of each attempt's first residual
  double balance = 0;                 // static solvers: largest final residual of a part [-]
  // Displacement [m] and force on the nodes [N/m] of every monitor of the model.
  std::vector<double> displacements;
  std::vector<double> reactions;
  std::optional<Energies> energies;  // dynamic runs only
};

// A model during a run, solved up to the committed time.
class Solver {
 public:
  Solver() = default;
  virtual ~Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Advances to a time in as many parts as needed; time 0 brings its loads to equilibrium. Throws
  // ComputationError with the place when it cannot.
  virtual LoadStep advance(double to, int number) = 0;

  // Sets the length of a load step, the unit of time steps that static solvers pass to their
  // points. Dynamics passes seconds.
  void set_load_step(double length) { load_step_ = length; }

  // Sets the observer of cuts in static solvers.
  void observe_cuts(CutObserver observer) { observe_cut_ = std::move(observer); }

  // Saves everything on which the next `advance` depends, between two calls. A solver of an equal
  // scene that restores it continues to the same bits. Throws as CheckpointReader does.
  virtual void save(CheckpointWriter& out) const = 0;
  virtual void restore(CheckpointReader& in) = 0;

  [[nodiscard]] virtual const PointField& points() const = 0;
  [[nodiscard]] virtual const Eigen::VectorXd& displacement() const = 0;  // committed [m]

 protected:
  // Time of a part for its points; one load step where time stands still.
  [[nodiscard]] double passed_time(double part) const { return part > 0 ? part / load_step_ : 1; }

  CutObserver observe_cut_;

 private:
  double load_step_ = 1;
};

using LoadObserver = std::function<void(const LoadStep&, const Solver&)>;

// Makes load steps: step 0 brings the loads at time 0 to equilibrium; steps 1..steps divide the
// duration evenly. Stops after step `last`; a restored solver continues with the step after the
// saved one.
void run_load_steps(Solver& solver, double duration, int steps, int last,
                    const LoadObserver& observe, int first = 0);

}  // namespace verification
