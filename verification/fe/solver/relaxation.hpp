// Dynamic relaxation of a finite element model to equilibrium at the end of every load step: explicit
// dynamics with adaptive viscous damping and time step (Liu et al., liu2019_biaxial eqs. 20-29).
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

struct RelaxationOptions {
  double tolerance = 1e-6;    // |force on the unknowns| / |nodal forces of the stresses| [-]
  int max_iterations = 5000;  // of one attempt, then the step is cut
  int max_cuts = 10;          // halvings of one step, at most
  double damping_ratio = 1;   // xi of eq. 25 [-]
  double safety = 0.8;        // of the critical time step, 2 / highest frequency [-]
};

// All evaluations of a load step start from the state committed at its begin, however the relaxation
// gets to its end: the answer is that of Newton's method, to the tolerance. No tangent but the
// elastic one, once per part of a load step. Throws as make_newton_solver does.
std::unique_ptr<Solver> make_relaxation_solver(const Model& model, const Material& material,
                                               const RelaxationOptions& options, int threads);

}  // namespace verification
