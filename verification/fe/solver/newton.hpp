// Newton's method for the equilibrium at the end of every load step.
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

struct NewtonOptions {
  unsigned tangent = GRAINLAW_WANT_TANGENT_EXACT;
  double tolerance = 1e-8;  // |force on the unknowns| / |nodal forces of the stresses| [-]
  int max_iterations = 20;  // per attempt; then the step is cut
  int max_cuts = 10;        // halvings of one step
  // Residual accepted at the smallest part of a step, counted as a loose part; 0: never [-]. P(F)
  // jumps where contacts collapse, and no displacement balances the loads there.
  double loose_tolerance = 0;
  // Residual at which an alternation across such a jump counts as converged, as a loose part; 0:
  // the step is cut [-].
  double jump_tolerance = 0;
  // Iterations after which one that leaves more than half of the residual indicates a jump; 0: only
  // a stalled attempt does.
  int jump_iterations = 0;
  // Iterations in a row without halving the residual that end an attempt with the exact tangent.
  // Points that ended loosely have inexact tangents and converge slowly: use more for them.
  int patience = 4;
  // Largest change of F per correction (Frobenius norm); corrections are shortened to it; 0: no
  // bound [-]. A correction far beyond the load increment is expensive and seldom useful.
  double largest_correction = verification::largest_correction;
  // Halvings of a correction until the residual does not increase and no point refuses; then the
  // step is cut. The first correction, which applies the load, is not halved; 0: none is.
  int line_search = 0;
  // Share of the stiffness at F = I that is added to the tangent after a correction raises the
  // residual; more while it rises, less while it falls (Levenberg and Marquardt); 0: none [-]. A
  // nearly singular tangent of softening points sends Newton across jumps of P. The result may be
  // the edge of a jump instead of an equilibrium: use it with jump_tolerance.
  double elastic_share = 0;
  // Whether the first guess repeats the last displacement (last_displacement.hpp) where the
  // prescription continues; else the committed tangent predicts. The guess is not shortened.
  bool last_displacement_first = false;
};

// Throws InputError for contradictory conditions, ComputationError when F = I cannot be evaluated.
std::unique_ptr<Solver> make_newton_solver(const Model& model, const Material& material,
                                           const NewtonOptions& options, int threads);

}  // namespace verification
