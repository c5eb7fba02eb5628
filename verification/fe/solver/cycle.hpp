// Cyclic tests: a side is driven until its displacement or force reaches a limit, then reversed.
// Displacement control passes liquefaction, where a prescribed force has no solution.
#pragma once

#include "app/scene.hpp"
#include "fe/solver/solver.hpp"

#include <limits>
#include <memory>
#include <string>

namespace verification {

struct Cycle {
  std::string drive;  // name of the prescribed displacement, e.g. "top_x"
  double step = 0;    // displacement per load step [m]
  double limit_displacement = std::numeric_limits<double>::infinity();  // [m]
  double limit_force = std::numeric_limits<double>::infinity();         // [N/m]
  double tolerance = 0.01;  // allowed error of the force at a reversal, over limit_force [-]
  int cycles = 1;           // from zero to both limits and to zero
  double end_displacement = std::numeric_limits<double>::infinity();  // ends the run [m]
  double end_mean_stress = 0;  // least mean compression of the specimen; ends the run [Pa]
  std::shared_ptr<LinearSegment> segment;  // program of the drive
};

// Reads [cycle]: on, component, step, limit_displacement, limit_force, tolerance, cycles,
// end_displacement, end_mean_stress. Adds the driven displacement to the model. Throws InputError.
Cycle read_cycle(SceneTable table, Model& model);

// State of a cyclic test. The solver's model must contain the cycle's displacement.
class CycleControl {
 public:
  CycleControl(const Cycle& cycle, const Model& model, double time_step);

  // Makes the next load step; step 0 is the start. A step whose force exceeds the limit is reverted
  // and repeated with a shorter part.
  LoadStep advance(Solver& solver, int number);

  [[nodiscard]] bool finished() const { return finished_; }
  [[nodiscard]] int reversals() const { return reversals_; }

  void save(CheckpointWriter& out) const;
  void restore(CheckpointReader& in);

 private:
  [[nodiscard]] double target() const;
  void look(double force, double mean_stress);

  Cycle cycle_;
  std::size_t monitor_ = 0;
  double time_step_;
  double time_ = 0;
  double displacement_ = 0;  // of the drive [m]
  double force_ = 0;         // on the drive [N/m]
  double direction_ = 1;
  int reversals_ = 0;
  bool finished_ = false;
};

// Makes load steps from `first` until the test or the number of steps ends.
void run_cycles(CycleControl& control, Solver& solver, int steps, const LoadObserver& observe,
                int first = 0);

}  // namespace verification
