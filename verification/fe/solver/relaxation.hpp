// Dynamic relaxation to equilibrium at the end of every load step: explicit dynamics with adaptive
// viscous damping and time step (Liu et al., liu2019_biaxial eqs. 20-29).
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

struct RelaxationOptions {
  double tolerance = 1e-6;    // |force on the unknowns| / |nodal forces of the stresses| [-]
  int max_iterations = 5000;  // per attempt; then the step is cut
  int max_cuts = grainlaw_march_options_default().max_cuts;
  double damping_ratio = 1;  // xi of eq. 25 [-]
  double safety = 0.8;       // factor on the critical time step, 2 / highest frequency [-]
};

// All evaluations of a load step start from the state committed at its start. The answer is
// therefore Newton's, to the tolerance. It needs elastic tangents alone, once per part of a load
// step. Throws as make_newton_solver does.
std::unique_ptr<Solver> make_relaxation_solver(const Model& model, const Material& material,
                                               const RelaxationOptions& options, int threads);

}  // namespace verification
