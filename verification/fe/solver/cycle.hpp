// Cyclic tests: a side is driven to and fro, and turns where its displacement or its force reaches a
// limit. Control by displacement gets through liquefaction, where a prescribed force has no answer.
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
  double tolerance = 0.01;  // of limit_force by which the force may miss it where it turns [-]
  int cycles = 1;           // from zero to both limits and back to zero
  double end_displacement = std::numeric_limits<double>::infinity();  // ends the run [m]
  double end_mean_stress = 0;  // ends the run where the specimen's compression falls below it [Pa]
  std::shared_ptr<StraightWay> segment;  // that the drive's program follows
};

// Reads [cycle]: on, component, step, limit_displacement, limit_force, tolerance, cycles,
// end_displacement, end_mean_stress; and adds the displacement that it drives to the model. Throws InputError.
Cycle read_cycle(SceneTable table, Model& model);

// Where a cyclic test stands. The solver's model must have the cycle's displacement.
class CycleControl {
 public:
  CycleControl(const Cycle& cycle, const Model& model, double time_step);

  // The next load step; step 0 is the start. A step whose force goes beyond the limit is taken
  // back and done shorter.
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

// Load steps from this one on, until the test is finished or so many steps are done.
void run_cycles(CycleControl& control, Solver& solver, int steps, const LoadObserver& observe,
                int first = 0);

}  // namespace verification
