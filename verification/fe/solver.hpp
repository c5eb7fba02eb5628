// Newton's method for a finite element model over a run of load steps.
#pragma once

#include "fe/model.hpp"

#include <functional>

namespace verification {

struct SolverOptions {
  unsigned tangent = GRAINLAW_WANT_TANGENT_EXACT;
  double tolerance = 1e-8;  // |force on the unknowns| / |nodal forces of the stresses| [-]
  int max_iterations = 20;  // of one attempt, then the step is cut
  int max_cuts = 10;        // halvings of one step, at most
  // Where contacts collapse P(F) jumps, and no displacement balances the loads to the last digit. A
  // step at its smallest cut is then taken whole to this residual, and the record counts it as a
  // loose part; 0: never [-].
  double loose_tolerance = 0;
  int threads = 0;          // <= 0: as many as the library takes
};

// One solved load step. Residuals: of every attempt one after the other; entry 0 of an attempt is
// the imbalance after the load increment, entry k the one after k linear solves.
struct LoadStep {
  Record record;  // means over the integration points
  std::vector<double> residuals;
  // Of every prescribed displacement: its value [m], and the force that holds it, summed over its
  // nodes, per metre of thickness [N/m].
  std::vector<double> displacements;
  std::vector<double> reactions;
};
using LoadObserver = std::function<void(const LoadStep&, const PointField&)>;

// Step 0 brings the loads at fraction 0 to equilibrium, steps 1..steps lead the run from fraction 0
// to steps_done / steps. Stops after `last` steps. Throws ComputationError, saying where, when a
// step fails at its smallest cut; InputError for contradictory conditions.
void run_load_steps(const Model& model, const Material& material, const SolverOptions& options,
                    int steps, int last, const LoadObserver& observe);

}  // namespace verification
