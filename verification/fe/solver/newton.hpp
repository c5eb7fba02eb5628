// Newton's method for the equilibrium at the end of every load step.
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

struct NewtonOptions {
  unsigned tangent = GRAINLAW_WANT_TANGENT_EXACT;
  // Those of the march; residuals are |force on the unknowns| / |nodal forces of the stresses| [-]. The
  // patience is that with the exact tangent. Points that ended loosely have inexact tangents and
  // converge slowly: use more for them.
  double tolerance = grainlaw_march_options_default().tolerance;
  int max_iterations = grainlaw_march_options_default().max_iterations;
  int max_cuts = grainlaw_march_options_default().max_cuts;
  int patience = grainlaw_march_options_default().patience;
  double largest_correction = grainlaw_march_options_default().largest_correction;
  // Residual accepted at the smallest part of a step, counted as a loose part; 0: never, jumps of P
  // are crossed [-]. P(F) jumps where contacts collapse, and no displacement balances the loads
  // there.
  double loose_tolerance = 0;
  // Halvings of a correction until the residual does not increase and no point refuses; then the
  // step is cut. The first correction, which applies the load, is not halved; 0: none is.
  int line_search = 0;
  // Share of the stiffness at F = I that is added to the tangent after a correction raises the
  // residual; more while it rises, less while it falls (Levenberg and Marquardt); 0: none [-]. A
  // nearly singular tangent of softening points sends Newton across jumps of P.
  double elastic_share = 0;
  // Whether the first guess repeats the last displacement (last_displacement.hpp) where the
  // prescription continues; else the committed tangent predicts. The guess is not shortened.
  bool last_displacement_first = false;
};

// Throws InputError for contradictory conditions, ComputationError when F = I cannot be evaluated.
std::unique_ptr<Solver> make_newton_solver(const Model& model, const Material& material,
                                           const NewtonOptions& options, int threads);

}  // namespace verification
