// Newton's method for the equilibrium of a finite element model at the end of every load step.
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

struct NewtonOptions {
  unsigned tangent = GRAINLAW_WANT_TANGENT_EXACT;
  double tolerance = 1e-8;  // |force on the unknowns| / |nodal forces of the stresses| [-]
  int max_iterations = 20;  // of one attempt, then the step is cut
  int max_cuts = 10;        // halvings of one step, at most
  // Where contacts collapse P(F) jumps, and no displacement balances the loads to the last digit. A
  // step at its smallest cut is then taken whole to this residual, and the record counts it as a
  // loose part; 0: never [-].
  double loose_tolerance = 0;
  // Newton going to and fro across such a jump without getting closer than this is taken for
  // converged, and counted as a loose part too; 0: the step is cut instead [-].
  double jump_tolerance = 0;
  // From so many iterations on, one that leaves more than half of the residual is enough to tell
  // such a jump; 0: it has to stall first.
  int jump_iterations = 0;
  // An attempt with the exact tangent ends when this many iterations in a row have not halved the
  // residual: it goes to and fro across a jump. With the tangents of points that ended loosely, which
  // are not exact, it gets there slowly but does: more for them.
  int patience = 4;
  // Corrections are shortened so that no F changes by more than this (Frobenius norm): a correction
  // far beyond the load increment costs far more to evaluate, and seldom leads anywhere; 0: no bound
  // [-].
  double largest_correction = 0;
  // Corrections are halved at most so many times until the residual does not increase, or a point
  // does not refuse; then the step is cut. The first, which brings the load, is made whole; 0: all
  // are.
  int line_search = 0;
  // Where a correction raises the residual this share of the stiffness at F = I is added to the
  // tangent, more if the next ones do too, less where they lower it: after Levenberg and Marquardt.
  // An exact tangent that is nearly singular, in points that soften, sends Newton far off, and P jumps
  // there. What it gets to is the edge of a jump as often as an equilibrium: for runs that have a
  // jump_tolerance. 0: none [-].
  double elastic_share = 0;
  // The first guess is the last move once more (last_move.hpp), where what is prescribed goes on the
  // same way; else what the committed tangent predicts. It is not shortened.
  bool last_move_first = false;
};

// Throws InputError for contradictory conditions, ComputationError when F = I cannot be evaluated.
std::unique_ptr<Solver> make_newton_solver(const Model& model, const Material& material,
                                           const NewtonOptions& options, int threads);

}  // namespace verification
