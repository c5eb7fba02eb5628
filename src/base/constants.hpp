// Every tuned number of the library stands here, with its meaning, its unit and where the value
// comes from.
//   sweep   varied by `verification/run sweep NAME=VALUE`; results in
//           verification/measured/speed.md, "What the constants of the solver are chosen by";
//   reach, start, newton, error, spheres   chosen by that study of `verification/run study`;
//   timed   chosen by run time, measured by a program that is not in the repository;
//   method  follows from the method or from the quantity it is compared with;
//   chosen  set by judgement; no command of the repository measures it.
// The compiler options GRAINLAW_TUNE_NAME="name" and GRAINLAW_TUNE_VALUE=value replace one of them.
#pragma once

#include <cstddef>
#include <string_view>

namespace grainlaw::core::tuned {

template <class Number>
constexpr Number chosen([[maybe_unused]] std::string_view name, Number value) {
#ifdef GRAINLAW_TUNE_NAME
  if (name == GRAINLAW_TUNE_NAME) return static_cast<Number>(GRAINLAW_TUNE_VALUE);
#endif
  return value;
}
#define GRAINLAW_TUNED(type, name, value) inline constexpr type name = chosen<type>(#name, value)

// Reference number of nodes for numbers that scale with the packing size [-]; most studies use
// packings of this size.
inline constexpr double usual_nodes = 400;

// ---- Neighbours and forces -------------------------------------------------------------------

// Gap within which neighbour pairs are listed [mean radii]. An increment of 0.1 % of strain rarely
// needs a second list, and few listed pairs never touch; error.
GRAINLAW_TUNED(double, listing_gap, 0.1);
// Number of contacts of one particle whose rounding errors add up in a residual [-]; method.
GRAINLAW_TUNED(double, contacts_of_a_particle, 8);
// Upper bound of the random scatter of forces, however coarse the tolerance [mean force]. Coarse
// solutions still have weak contacts that are real; method.
GRAINLAW_TUNED(double, largest_chance, 1e-4);
// Force above which a contact counts [multiples of the random scatter]; method.
GRAINLAW_TUNED(double, more_than_chance, 10);

// ---- Relaxation ------------------------------------------------------------------------------

// Ratio of pseudo-mass to the sum of contact stiffnesses [-]. The unit step is stable below 1;
// sweep.
GRAINLAW_TUNED(double, mass_factor, 0.8);
// Ratio of pseudo-mass to stiffness for components of F that are found [-]; method.
GRAINLAW_TUNED(double, deformation_mass_factor, 0.8);
// Steps between updates of the masses [steps]. Older masses exceed the stability limit because
// contacts have closed since; sweep; in space: spheres.
template <int D>
GRAINLAW_TUNED(long, mass_interval, (D == 2 ? 10 : 15));
// Gap of contacts that take part in steps of spheres, besides a mean overlap: multiples of the largest
// displacement between the last two updates [-]; chosen.
GRAINLAW_TUNED(double, near_moves, 2);
// Residual above which steps are in single precision, whose rounding is a tenth of it [-];
// method.
GRAINLAW_TUNED(double, single_precision, 1e-5);
// Steps between updates of the masses while contacts hardly change, a multiple of mass_interval
// [steps]; sweep.
GRAINLAW_TUNED(long, long_interval, 30);
// Residual, and its rise since the last relinearisation, below which long_interval applies [-];
// sweep.
GRAINLAW_TUNED(double, skip_refresh_residual, 1e-2);
GRAINLAW_TUNED(double, skip_refresh_rise, 3);
// Steps in a window, after which the lower bound of the damping is reviewed [steps]; reach.
GRAINLAW_TUNED(long, floor_window, 100);
// First value of the lower bound of the damping, and its largest value for usual_nodes [-]. The
// largest falls as N^-0.5. A high bound suppresses flutter, a low one lets soft modes move, which
// are softer in large packings; sweep.
GRAINLAW_TUNED(double, first_floor, 0.1);
GRAINLAW_TUNED(double, largest_floor, 0.25);
// Ratios that classify a window [-]. It is slow above slow_window (last over first residual) and
// oscillates above oscillating_window (largest over smallest). It gains below gaining_window
// (largest over the least largest before); reach.
GRAINLAW_TUNED(double, slow_window, 0.5);
GRAINLAW_TUNED(double, oscillating_window, 2);
GRAINLAW_TUNED(double, gaining_window, 0.7);
// Residual above which a relaxation may flutter without end [-], steps without gain until it is
// given up, and their growth exponent with N. Fluttering clusters are as small in large packings;
// sweep.
GRAINLAW_TUNED(double, flutter_residual, 3e-3);
GRAINLAW_TUNED(double, flutter_patience, 500);
GRAINLAW_TUNED(double, flutter_growth, 0.25);
// Largest damping of a step [-]. A larger one would reverse the velocity; method.
GRAINLAW_TUNED(double, largest_damping, 1.9);
// Largest change of a found component of F per step and per increment [-]. Beyond it no contact
// carries the stress; method.
GRAINLAW_TUNED(double, largest_deformation_step, 1e-3);
GRAINLAW_TUNED(double, largest_found_change, 1);

// ---- Subspace extrapolation ------------------------------------------------------------------

// First step with an extrapolation, interval between checks (a multiple of long_interval) [steps],
// and growth of the pause after each extrapolation [-]. The relaxation needs time to remove what an
// extrapolation disturbs; sweep.
GRAINLAW_TUNED(long, first_extrapolation, 200);
GRAINLAW_TUNED(long, extrapolation_interval, 30);
GRAINLAW_TUNED(double, longer_pause, 1.5);
// Residual, and ratio of its largest to its smallest value since the last check, below which
// contacts rarely switch [-]; sweep.
GRAINLAW_TUNED(double, extrapolation_residual, 2e-3);
GRAINLAW_TUNED(double, restless, 6);
// Ratio of the residuals after and before the recorded displacements, above which the relaxation
// creeps [-]; reach.
GRAINLAW_TUNED(double, creeping, 0.125);
// Largest displacement of a component [mean overlaps], and least stiffness along the displacements
// [mean stiffness]. A displacement is independent if it adds this share of its square to the others
// [-]; reach.
GRAINLAW_TUNED(double, longest_extrapolation, 0.3);
GRAINLAW_TUNED(double, least_stiffness, 1e-6);
GRAINLAW_TUNED(double, independent_move, 1e-6);

// ---- Pseudo-transient continuation -----------------------------------------------------------

// First shift s, shift below which it becomes 0, and shift at which the method gives up [-].
// @formula newton; newton.
GRAINLAW_TUNED(double, first_shift, 1e-5);
GRAINLAW_TUNED(double, least_shift, 1e-7);
GRAINLAW_TUNED(double, largest_shift, 1e3);
// Shift at the start of the flow, and the limit up to which an overlong full step raises the shift
// [-]; newton.
GRAINLAW_TUNED(double, flow_shift, 1e-2);
// Ratios of the residual after a step to that before [-]: good, acceptable, and lost above the
// largest rise; newton.
GRAINLAW_TUNED(double, good_step, 0.1);
GRAINLAW_TUNED(double, acceptable_step, 0.9);
GRAINLAW_TUNED(double, largest_rise, 300);
// Residual over the best residual, below which the flow returns to full steps [-]; newton.
GRAINLAW_TUNED(double, sufficient_gain, 0.5);
// Longest full step [mean overlaps] and longest flow step [smallest radius]. Longer displacements
// exchange contacts and lead to another packing; newton.
GRAINLAW_TUNED(double, longest_full_step, 3);
GRAINLAW_TUNED(double, longest_flow_step, 0.2);
// Least share of a full step that is still informative [-]. Below it the step is dropped and the
// shift rises; sweep.
GRAINLAW_TUNED(double, least_share, 0.1);
// Number of full steps without gain, and relative change of the residual that counts as no change
// [-]; sweep.
GRAINLAW_TUNED(int, full_step_patience, 4);
GRAINLAW_TUNED(double, no_change, 1e-2);
// Length of the relaxation after a step, enough to balance forces around single contacts [steps];
// sweep.
GRAINLAW_TUNED(long, settling_steps, 60);
// Most corrections of one implicit flow step, and the rise of the residual that ends them early
// [-]; sweep.
GRAINLAW_TUNED(int, most_corrections, 5);
GRAINLAW_TUNED(double, diverging_correction, 1e4);
// Stiffness of the spring that enforces the rule of a two-contact sphere [its mass].
// @formula free-spin; method.
GRAINLAW_TUNED(double, chord_spring, 0.1);
// Upper bound of the force above which a contact supports a sphere, however coarse the tolerance
// [mean force]. Chosen; docs/theory.md, "How an increment is solved", has the rule of two-contact
// spheres.
GRAINLAW_TUNED(double, least_supporting_force, 1e-5);
// Least cosine between the path of a two-contact sphere and the direction to a third sphere in its
// way [-]; method.
GRAINLAW_TUNED(double, least_closing, 0.05);
// Least moment of a rolling mechanism that counts [tolerance]; method.
GRAINLAW_TUNED(double, least_moment, 0.3);

// ---- Linear solves ---------------------------------------------------------------------------

// Gap below which a contact stays in the matrix graph [radii]. The graph then lasts while contacts
// open and close; error.
GRAINLAW_TUNED(double, graph_gap, 1e-3);
// Regularisation of the factors for rattlers and for the translation of the cell [masses].
// Iterative refinement removes its effect; method.
GRAINLAW_TUNED(double, regularisation, 1e-12);
// Residuals relative to the largest entry of the right-hand side [-]: target of GMRES, target for
// several columns together, and the largest usable one; error.
GRAINLAW_TUNED(double, good_solution, 1e-12);
GRAINLAW_TUNED(double, good_together, 1e-10);
GRAINLAW_TUNED(double, usable_solution, 1e-6);
// Reductions of the residual per refinement step [-]: with new factors, and with old factors.
// Slower refinement with old factors costs more than a factorisation. Below settled_solution the
// rest is rounding, whatever the factors; error.
GRAINLAW_TUNED(double, slow_refinement, 0.5);
GRAINLAW_TUNED(double, quick_refinement, 0.05);
GRAINLAW_TUNED(double, settled_solution, 1e-9);

// Number of spheres from which Krylov methods with incomplete factors replace LU factors [-]. With
// LU the cost is equal at 200, three times at 500 and five times at 1000; spheres, also built with
// 1000000.
GRAINLAW_TUNED(std::size_t, iterative_nodes, 250);
// Regularisation of the incomplete factors for rattlers [masses]. Values of 1e-4 to 1e-2 perform
// alike, others need twice the products; timed.
GRAINLAW_TUNED(double, incomplete_regularisation, 1e-3);
// Residual reductions of a linear solve in a Newton step [-]: the largest, the least as a share of
// the tolerance, and the largest that is usable. Between them it is the square of the last
// reduction. Chosen; verification/measured/spheres.md has run times with these values.
GRAINLAW_TUNED(double, loose_step, 1e-2);
GRAINLAW_TUNED(double, share_of_tolerance, 0.1);
GRAINLAW_TUNED(double, usable_step, 0.1);
// Residual target of the derivatives of an equilibrium [-]. Errors along soft modes are larger than
// it; error.
GRAINLAW_TUNED(double, derivative_residual, 1e-9);
// Residual target of derivatives as a share of a coarse tolerance, and its upper bound [-]. Krylov
// methods often stall below it, and factors cost more than the rest is worth; error.
GRAINLAW_TUNED(double, derivative_share, 1e-3);
GRAINLAW_TUNED(double, loose_derivative_residual, 1e-6);
// Reduction of the residual in a cycle of BiCGStab in single precision, the most products of a cycle,
// and the reduction above which cycles stall [-]; timed.
GRAINLAW_TUNED(double, reduction_of_cycle, 1e-3);
GRAINLAW_TUNED(int, products_of_cycle, 100);
GRAINLAW_TUNED(double, slow_cycle, 0.5);
// Most products of one Krylov method before the next one starts, several times the usual number
// [products]; timed.
GRAINLAW_TUNED(int, most_products, 400);

// ---- Drag ------------------------------------------------------------------------------------

// Stiffness of the springs over the mean contact force per radius [-]. @formula viscous; chosen.
template <int D>
GRAINLAW_TUNED(double, drag_stiffness, (D == 2 ? 1.0 : 2.0));
// Share of a contact's stiffness that the springs have without forces [-]; chosen.
GRAINLAW_TUNED(double, drag_floor, 5e-4);
// That share where forces may fade [-]; chosen.
GRAINLAW_TUNED(double, fading_drag_floor, 1.5e-3);
// Share of their stiffness that the springs have where the strain turns back [-]; chosen.
GRAINLAW_TUNED(double, drag_of_reversal, 0.1);
// Mean strain rate over the viscous number below which nothing turns back [-]; chosen.
GRAINLAW_TUNED(double, slowest_drag_rate, 0.01);
// Strain from which on parts are slower, as sqrt(e:e / 2): without drag in shear bands, meshes lost
// contacts there; chosen.
GRAINLAW_TUNED(double, large_drag_strain, 1e-3);
// Duration from which on a part has no drag to speak of [memories]; method.
GRAINLAW_TUNED(double, longest_drag, 36);
// Bound of the time for which the drag's masses are followed [memories]; chosen.
GRAINLAW_TUNED(double, longest_follow, 3);
// Strain up to which an increment counts as a hold, which may take no time [-]; chosen.
GRAINLAW_TUNED(double, largest_held_strain, 1e-9);
// Largest drag over the mean contact force above which reports warn [-]; chosen.
GRAINLAW_TUNED(double, much_drag, 0.1);
// Residual at which a relaxation with drag hands over to Newton [-]; chosen.
GRAINLAW_TUNED(double, drag_hand_over, 1e-4);

// ---- Strategy --------------------------------------------------------------------------------

// Residual at which a relaxation hands over to Newton for usual_nodes [-], and exponent with which
// it falls. Newton's region of convergence shrinks with the packing size; sweep; in space: spheres.
template <int D>
GRAINLAW_TUNED(double, hand_over, (D == 2 ? 5e-4 : 2e-5));
GRAINLAW_TUNED(double, hand_over_power, 1.2);
// Ratio of tolerance to hand_over above which relaxation alone is faster [-]; reach.
GRAINLAW_TUNED(double, worth_newton, 0.5);
// Tiny increments: tolerance over the relative change of a contact's force, strain that counts as none
// [-]. Most steps of a relaxation before Newton, of which an iteration costs as many [steps]; error.
GRAINLAW_TUNED(double, share_of_increment, 0.03);
GRAINLAW_TUNED(double, least_strain, 1e-13);
GRAINLAW_TUNED(long, steps_of_tiny_increment, 100);
// Factors by which later rounds lower the residual of the hand-over [-]; sweep.
GRAINLAW_TUNED(double, tighter, 0.3);
GRAINLAW_TUNED(double, much_tighter, 0.1);
// Most rounds of relaxation and Newton per sub-increment [-]: in general, with a loose tolerance,
// and after an earlier iteration of the step fluttered; reach.
GRAINLAW_TUNED(int, rounds, 9);
GRAINLAW_TUNED(int, bounded_rounds, 3);
GRAINLAW_TUNED(int, repeated_rounds, 2);
// Rounds relaxed to the target after which sub-increments start, for usual_nodes and at least [-].
// One whole increment in a thousand still converges after them, and two sub-increments are cheaper;
// sweep.
GRAINLAW_TUNED(int, enough_rounds, 6);
GRAINLAW_TUNED(int, least_rounds, 3);
// Round from which relaxations take twice the steps [-]; reach.
GRAINLAW_TUNED(int, long_rounds, 5);
// Most factorisations of the first round and of later rounds [-], in general and with a loose
// tolerance. Where Newton converges from the first iterate it needs few; sweep.
GRAINLAW_TUNED(int, first_factorisations, 20);
GRAINLAW_TUNED(int, most_factorisations, 50);
GRAINLAW_TUNED(int, bounded_first_factorisations, 8);
GRAINLAW_TUNED(int, bounded_factorisations, 20);
// Factorisations in each of the first rounds whose relaxation did not converge, and the number of
// those rounds [-]. Newton rarely converges from there, and another relaxation is cheaper; sweep.
GRAINLAW_TUNED(int, unsettled_factorisations, 12);
GRAINLAW_TUNED(int, unsettled_rounds, 2);
// Most steps of a relaxation [steps] for usual_nodes, growing as N^0.5: in general, with a loose
// tolerance, and with advancing history; sweep.
GRAINLAW_TUNED(double, relaxation_steps, 2000);
GRAINLAW_TUNED(double, bounded_relaxation_steps, 1000);
GRAINLAW_TUNED(double, advancing_steps, 75000);
// Most sub-increments, and most refinement of the number that the increment's size asks for [-];
// reach.
GRAINLAW_TUNED(int, most_subincrements, 64);
GRAINLAW_TUNED(int, finest_refinement, 8);
// Upper bound of the rounding error that raises the tolerance [-]; method.
GRAINLAW_TUNED(double, largest_rounding, 1e-3);
// Mean force at equilibrium over that of the guess [-], and distance from affine motion [mean branches],
// beyond which particles were pushed through one another; chosen.
GRAINLAW_TUNED(double, largest_gain, 10);
GRAINLAW_TUNED(double, farthest_move, 1);
// Mean forces at which a packing that may lose its contacts is free of stress, and may become so
// [mean force at F = I]; reach.
GRAINLAW_TUNED(double, faded, 1e-6);
GRAINLAW_TUNED(double, fading, 1e-2);

#undef GRAINLAW_TUNED

}  // namespace grainlaw::core::tuned
