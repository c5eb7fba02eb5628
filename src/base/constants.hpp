// Every number that was tuned, in one place: meaning, unit, and where it comes from.
//   sweep  `verification/run sweep NAME=VALUE` leads the paths of `grainlaw_evidence reach` with another value;
//          verification/README.md has what came of it
//   reach, start, newton, error, spheres  studies of `verification/run study` that it was chosen by
//   timed  as `spheres` does, by a program that was not kept
//   method  follows from what it is compared with
// One of them may be given to the compiler as GRAINLAW_TUNE_NAME="name" and GRAINLAW_TUNE_VALUE=value.
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

// Sizes of packings are relative to this many nodes, of which most of the studies are.
inline constexpr double usual_nodes = 400;

// ---- Neighbours and forces -------------------------------------------------------------------

// Pairs are listed within this gap: wide enough that an increment of 0.1 % rarely lists twice, narrow
// enough that few listed pairs never touch [mean radii]; error.
GRAINLAW_TUNED(double, listing_gap, 0.1);
// Contacts of a particle whose rounding errors add up in a residual [-]; method.
GRAINLAW_TUNED(double, contacts_of_a_particle, 8);
// A coarse solution still has real contacts that carry little: what differs by chance is no more than
// this [mean force]; method.
GRAINLAW_TUNED(double, largest_chance, 1e-4);
// A contact counts from so many times what differs by chance on [-]; method.
GRAINLAW_TUNED(double, more_than_chance, 10);

// ---- Relaxation ------------------------------------------------------------------------------

// Pseudo-masses over the sum of stiffnesses: a unit step is stable below 1 [-]; sweep.
GRAINLAW_TUNED(double, mass_factor, 0.8);
// The same for found components of F [-]; method.
GRAINLAW_TUNED(double, deformation_mass_factor, 0.8);
// Masses older than this are past the stability limit: contacts have closed meanwhile [steps]; sweep.
GRAINLAW_TUNED(long, mass_interval, 10);
// And where a relaxation is calm; a multiple of the one before [steps]; sweep.
GRAINLAW_TUNED(long, long_interval, 30);
// It is calm below this residual [-], unless that rose so much since the last look [-]; sweep.
GRAINLAW_TUNED(double, calm_residual, 1e-2);
GRAINLAW_TUNED(double, calm_rise, 3);
// Steps after which the floor of the damping is reviewed [steps]; reach.
GRAINLAW_TUNED(long, floor_window, 100);
// A high floor keeps flutter down, a low one lets soft modes move, which are softer in large packings:
// where it begins, and the highest with up to usual_nodes, falling as N^-0.5 [-]; sweep.
GRAINLAW_TUNED(double, first_floor, 0.1);
GRAINLAW_TUNED(double, largest_floor, 0.25);
// A window is slow that leaves more than this of the residual; it oscillates with more than this
// between largest and smallest; it gains with less than this of the least largest before [-]; reach.
GRAINLAW_TUNED(double, slow_window, 0.5);
GRAINLAW_TUNED(double, oscillating_window, 2);
GRAINLAW_TUNED(double, gaining_window, 0.7);
// Friction flutters without end above this residual [-] after so many steps without a gain, with up to
// usual_nodes, growing with this power: clusters that flutter are as small in large packings; sweep.
GRAINLAW_TUNED(double, flutter_residual, 3e-3);
GRAINLAW_TUNED(double, flutter_patience, 500);
GRAINLAW_TUNED(double, flutter_growth, 0.25);
// Of the damping in a step: beyond, a velocity would turn round [-]; method.
GRAINLAW_TUNED(double, largest_damping, 1.9);
// Of a found component of F in a step, and in an increment: beyond, nothing carries the stress [-]; method.
GRAINLAW_TUNED(double, largest_deformation_step, 1e-3);
GRAINLAW_TUNED(double, largest_found_change, 1);

// ---- Subspace extrapolation ------------------------------------------------------------------

// Not before this step; from look to look, a multiple of long_interval; and each pause after one is
// this much longer than the last: what an extrapolation disturbs needs the relaxation [steps]; sweep.
GRAINLAW_TUNED(long, first_extrapolation, 200);
GRAINLAW_TUNED(long, extrapolation_interval, 30);
GRAINLAW_TUNED(double, longer_pause, 1.5);
// Below this residual contacts switch seldom; with more than this between largest and smallest since
// the last look they do [-]; sweep.
GRAINLAW_TUNED(double, extrapolation_residual, 2e-3);
GRAINLAW_TUNED(double, restless, 6);
// It creeps where the seen moves leave more than this of the residual [-]; reach.
GRAINLAW_TUNED(double, creeping, 0.125);
// No component moves further [mean overlaps]; along the moves there is at least this stiffness [of the
// mean one]; a move is independent that adds this share of its square to the others [-]; reach.
GRAINLAW_TUNED(double, longest_extrapolation, 0.3);
GRAINLAW_TUNED(double, least_stiffness, 1e-6);
GRAINLAW_TUNED(double, independent_move, 1e-6);

// ---- Pseudo-transient continuation -----------------------------------------------------------

// The shift where it begins, below which it is none, and where it is given up [of the masses]; newton.
GRAINLAW_TUNED(double, first_shift, 1e-5);
GRAINLAW_TUNED(double, least_shift, 1e-7);
GRAINLAW_TUNED(double, largest_shift, 1e3);
// With which the flow begins, and up to which a full step that reaches too far raises it; newton.
GRAINLAW_TUNED(double, flow_shift, 1e-2);
// Residual after a step over before: so little is good, this acceptable, more is lost [-]; newton.
GRAINLAW_TUNED(double, good_step, 0.1);
GRAINLAW_TUNED(double, acceptable_step, 0.9);
GRAINLAW_TUNED(double, largest_rise, 300);
// The flow hands back to full steps when it leaves less than this of the best residual [-]; newton.
GRAINLAW_TUNED(double, enough_gain, 0.5);
// Longer moves turn contacts over; what lies beyond is another packing: of full steps [mean overlaps],
// of the flow's [smallest radius]; newton.
GRAINLAW_TUNED(double, longest_full_step, 3);
GRAINLAW_TUNED(double, longest_flow_step, 0.2);
// Less of a step within reach does not tell what is wrong with the rest [-]; sweep.
GRAINLAW_TUNED(double, least_share, 0.1);
// Full steps without a gain, and a change of the residual that is none [-]; sweep.
GRAINLAW_TUNED(int, full_step_patience, 4);
GRAINLAW_TUNED(double, the_same, 1e-2);
// Of a relaxation after a step, long enough for what it leaves around single contacts [steps]; sweep.
GRAINLAW_TUNED(long, settling_steps, 60);
// Of the flow's own equation in a step; not where it left so many times the residual; sweep.
GRAINLAW_TUNED(int, most_corrections, 5);
GRAINLAW_TUNED(double, hopeless_correction, 1e4);
// What holds the free spin of a sphere with two contacts to its rule [of its mass]; method.
GRAINLAW_TUNED(double, free_spin_hold, 0.1);
// A contact that carries less of the mean force may hold it or not, however coarse the tolerance is [-];
// design of spheres.
GRAINLAW_TUNED(double, least_holding_force, 1e-5);
// A third sphere is in its way where the way leads so much towards it [-]; method.
GRAINLAW_TUNED(double, least_closing, 0.05);
// Moments of rolling mechanisms count from this on [of the tolerance]; method.
GRAINLAW_TUNED(double, least_moment, 0.3);

// ---- Linear solves ---------------------------------------------------------------------------

// Contacts with a smaller gap stay in the graph, so that it lasts while they open and close [radii];
// error.
GRAINLAW_TUNED(double, graph_gap, 1e-3);
// Holds rattlers and the translation of the cell in the factors; refinement takes it out again [of the
// masses]; method.
GRAINLAW_TUNED(double, grounding, 1e-12);
// Residual relative to the largest entry of the right-hand side: aimed at by GMRES, by several together,
// and what still serves [-]; error.
GRAINLAW_TUNED(double, good_solution, 1e-12);
GRAINLAW_TUNED(double, good_together, 1e-10);
GRAINLAW_TUNED(double, usable_solution, 1e-6);
// Refinement goes on while it falls to less than this share. With old factors it has to be quick, or a
// factorisation is cheaper; below `settled_solution` what stays is rounding, by whatever factors; error.
GRAINLAW_TUNED(double, slow_refinement, 0.5);
GRAINLAW_TUNED(double, quick_refinement, 0.05);
GRAINLAW_TUNED(double, settled_solution, 1e-9);

// Spheres: Krylov methods with incomplete factors instead of factors from so many particles on; they
// cost the same at 200, a third at 500, a fifth at 1000 [-]; spheres, and built with 1000000.
GRAINLAW_TUNED(std::size_t, iterative_nodes, 250);
// Holds rattlers in the incomplete factors: of 1e-2 to 1e-4 any does as well, less or more takes twice
// the products [of the masses]; timed.
GRAINLAW_TUNED(double, incomplete_grounding, 1e-3);
// A step of Newton's method leaves no more than this of the residual; after a full one the square of
// what that left, but no less than this share of the tolerance; and one that leaves this much serves
// [-]; design of spheres.
GRAINLAW_TUNED(double, loose_step, 1e-2);
GRAINLAW_TUNED(double, share_of_tolerance, 0.1);
GRAINLAW_TUNED(double, usable_step, 0.1);
// What is left of the derivatives of an equilibrium, soft modes of which are off by more [-]; error.
GRAINLAW_TUNED(double, derivative_residual, 1e-9);
// Where the equilibrium itself is found to a coarse tolerance, this share of that, up to the second: often no method
// gets further there, and factors cost more than what is left is worth [-]; error.
GRAINLAW_TUNED(double, derivative_share, 1e-3);
GRAINLAW_TUNED(double, loose_derivative_residual, 1e-6);
// Of a method before another goes on, several times what it usually takes [products]; timed.
GRAINLAW_TUNED(int, most_products, 400);

// ---- Drag ------------------------------------------------------------------------------------

// How many times the last move may be expected again where the strain goes faster [-]; post-peak design.
GRAINLAW_TUNED(double, largest_follow, 3);
// An increment of less strain has no direction to go on in: fluctuations of one that only takes time, as
// where a host holds a body, would else be expected to follow any next one, however it deforms [-];
// post-peak design; chosen, and verification/README.md (Without jumps) says between what.
GRAINLAW_TUNED(double, least_followed_strain, 1e-9);
// Relaxation with drag hands over to Newton at this residual, of spheres not at all [-]; post-peak design.
GRAINLAW_TUNED(double, drag_hand_over, 1e-3);

// ---- Strategy --------------------------------------------------------------------------------

// Relaxation hands over to Newton at this residual with up to usual_nodes, falling with this power:
// Newton's reach shrinks with the packing's size [-]; sweep.
GRAINLAW_TUNED(double, hand_over, 5e-4);
GRAINLAW_TUNED(double, hand_over_power, 1.2);
// A target looser than this share of it is sooner reached by relaxation alone [-]; reach.
GRAINLAW_TUNED(double, worth_newton, 0.5);
// The next rounds hand over this much tighter, the later ones more [-]; sweep.
GRAINLAW_TUNED(double, tighter, 0.3);
GRAINLAW_TUNED(double, much_tighter, 0.1);
// Rounds of relaxation and Newton on a sub-increment: at most, with a loose tolerance to end at, and
// where an earlier iteration of the step fluttered [-]; reach.
GRAINLAW_TUNED(int, rounds, 9);
GRAINLAW_TUNED(int, bounded_rounds, 3);
GRAINLAW_TUNED(int, repeated_rounds, 2);
// After so many, relaxed down to the target, one whole increment in a thousand still settles: two
// sub-increments are cheaper. Fewer in large packings, no less than the second [-]; sweep.
GRAINLAW_TUNED(int, enough_rounds, 6);
GRAINLAW_TUNED(int, least_rounds, 3);
// From this round on relaxations are twice as long [-]; reach.
GRAINLAW_TUNED(int, long_rounds, 5);
// Factorisations of a round: where Newton works at once it works soon; later rounds; and the same two
// with a loose tolerance [-]; sweep.
GRAINLAW_TUNED(int, first_factorisations, 20);
GRAINLAW_TUNED(int, most_factorisations, 50);
GRAINLAW_TUNED(int, bounded_first_factorisations, 8);
GRAINLAW_TUNED(int, bounded_factorisations, 20);
// Newton seldom works from where the relaxation did not settle: so many in so many first rounds, after
// which another relaxation is the cheaper try [-]; sweep.
GRAINLAW_TUNED(int, unsettled_factorisations, 12);
GRAINLAW_TUNED(int, unsettled_rounds, 2);
// Of a relaxation with up to usual_nodes, growing as N^0.5; with a loose tolerance; and with advancing
// history [steps]; sweep.
GRAINLAW_TUNED(double, relaxation_steps, 2000);
GRAINLAW_TUNED(double, bounded_relaxation_steps, 1000);
GRAINLAW_TUNED(double, advancing_steps, 75000);
// Sub-increments: at most, and times those that the size of the increment asks for [-]; reach.
GRAINLAW_TUNED(int, most_subincrements, 64);
GRAINLAW_TUNED(int, finest_refinement, 8);
// No tolerance is met below what rounding leaves, which counts up to this [-]; method.
GRAINLAW_TUNED(double, largest_rounding, 1e-3);
// Forces below this count for nothing where contacts may be lost, and below the second an increment
// that does not settle may be on its way there [mean force at F = I]; reach.
GRAINLAW_TUNED(double, faded, 1e-6);
GRAINLAW_TUNED(double, fading, 1e-2);

#undef GRAINLAW_TUNED

}  // namespace grainlaw::core::tuned
