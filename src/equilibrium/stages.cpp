#include "equilibrium/stages.hpp"

#include "base/constants.hpp"
#include "equilibrium/drag_start.hpp"
#include "equilibrium/effort.hpp"
#include "equilibrium/tiny_increment.hpp"
#include "increment/contact_state.hpp"
#include "reference/servo.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Mean force below which the packing counts as free of stress [N]. Bonds need no force and exclude
// that: 0.
template <int D>
double zero_force_share(const Request<D>& request, const Increment<D>& increment) {
  if (!may_be_free(request) || request.problem->law->bonds()) return 0;
  return std::max(std::min(request.tolerance, tuned::faded) * unloaded_force(*request.problem),
                  increment.scale().rounding());
}

// True if no contact touches, or if all forces have faded; then contacts are released.
template <int D>
bool is_free(const Request<D>& request, Increment<D>& increment) {
  if (!may_be_free(request)) return false;
  increment.refresh_masses();
  increment.update_forces();
  if (increment.scale().touching() == 0) return true;
  if (increment.scale().mean_force() >= zero_force_share(request, increment)) return false;
  increment.release_contacts();
  return true;
}

template <int D>
void start_iteration(const Request<D>& request, double share, Increment<D>& increment) {
  increment.begin(*request.problem, *request.from,
                  between<D>(request.from->deformation, request.deformation, share));
  if (request.guess != nullptr && share == 1) {
    increment.motion().go_to(*request.guess, request.guess_deformation);
    if (!request.guess_step.empty()) increment.motion().move(request.guess_step);
    increment.deform(request.deformation);
  }
}

// Mean force of the guess, at least that at F = I [N].
template <int D>
double given_force(const Increment<D>& increment) {
  return std::max(increment.scale().mean_force(), unloaded_force(increment.problem()));
}

// True if a particle is far from where a step to equilibrium may take it.
template <int D>
bool flew_away(const Request<D>& request, Increment<D>& increment) {
  auto& motion = increment.motion();
  return motion.largest_fluctuation(*request.from) > tuned::farthest_move * motion.mean_branch();
}

// True if a particle flew away, or forces grew far beyond the given one [N]. The way to equilibrium
// loses energy, so particles were pushed through one another on it.
template <int D>
bool exploded(const Request<D>& request, double given, Increment<D>& increment) {
  if (increment.problem().space->finds_deformation) return false;
  // Where a step resolves it, inertia holds forces in their place, however much an impact makes of them.
  const double theta = increment.motion().drag().how().theta;
  const bool gained = increment.scale().mean_force() > tuned::largest_gain * given;
  return (gained && !(theta > 0 && theta < 0.75)) || flew_away(request, increment);
}

template <int D>
bool has_drag(const Request<D>& request) {
  return request.options->viscosity.number > 0 || request.problem->inertia;
}

// Tolerance, raised to what rounding leaves [-]. It changes while forces fade.
template <int D>
double reachable(const Request<D>& request, const Increment<D>& increment) {
  return std::max(request.tolerance, least_tolerance(increment));
}

// Relaxes and solves by Newton in rounds from the guess. Later rounds go on from the last iterate
// and relax longer and tighter, at last down to the target.
template <int D>
bool find_equilibrium(const Request<D>& request, Workspace<D>& w, Outcome& outcome) {
  const bool whole = outcome.subincrements == 1;
  auto& increment = w.increment;
  const Effort& effort = effort_of(request);
  const long steps = relaxation_limit(effort.relaxation_steps, increment.problem().nodes());
  const auto limit_to = [&](int count, int least) {
    return limit_of(count, least, increment.problem().nodes());
  };
  const int rounds = limit_to(effort.rounds, tuned::least_rounds);
  const int enough = limit_to(tuned::enough_rounds, tuned::least_rounds);
  const int most_factorisations =
      limit_to(effort.most_factorisations, tuned::unsettled_factorisations);
  if (request.trying == Trying::whole && increment.scale().below_rounding())
    return is_free(request, increment);
  double target = reachable(request, increment);
  double hand_over = hand_over_of<D>(increment.problem().nodes());
  if (has_drag(request)) hand_over = tuned::drag_hand_over;
  const bool coarse = target > tuned::worth_newton * hand_over;
  w.relaxation.single_precision = D == 3 || coarse;
  if (whole && solve_tiny(request, target, hand_over, steps, w)) return true;
  if (coarse) hand_over = target;
  bool last = false;
  for (int round = 0; !last && round < rounds; ++round) {
    last = whole && round >= enough && hand_over <= target;
    const double tolerance = std::max(hand_over, target);
    const long limit = (round < tuned::long_rounds ? 1 : 2) * steps;
    // Without extrapolation the iterates of a step stay on one branch of equilibria.
    const bool may_extrapolate = request.guess == nullptr && !has_drag(request);
    const bool relaxed =
        relax(increment, tolerance, limit, History::committed, w.relaxation, 0, may_extrapolate);
    if (lost(increment) || increment.runs_away()) return is_free(request, increment);
    const bool there = relaxed && tolerance == target;
    if (there && (coarse || increment.find_two_contact_spheres() < target)) return true;
    const auto is_loose = [&] { return increment.residual_norm() < request.loose_tolerance; };
    if (request.guess_loose && !relaxed && is_loose()) return outcome.loose = true;
    const bool unsettled = !relaxed && round < tuned::unsettled_rounds;
    const int factorisations = unsettled    ? tuned::unsettled_factorisations
                               : round == 0 ? effort.first_factorisations
                                            : most_factorisations;
    // A packing that loses its forces settles nowhere.
    auto* const settling = may_fade(request, increment) ? nullptr : &w.relaxation;
    if (pseudo_transient_newton(increment, target, factorisations, w.newton, settling)) return true;
    if ((round > 0 || request.guess_loose) && is_loose()) return outcome.loose = true;
    hand_over *= round < 2 ? tuned::tighter : tuned::much_tighter;
    target = reachable(request, increment);
  }
  return is_free(request, increment);
}

// Solves one sub-increment.
template <int D>
bool solve_part(const Request<D>& request, Workspace<D>& w, Outcome& outcome) {
  w.increment.refresh_masses();
  const double given = given_force(w.increment);
  return find_equilibrium(request, w, outcome) && !exploded(request, given, w.increment);
}

// Breaks the overloaded bonds at an equilibrium and solves again at the same F, until no bond is
// overloaded.
template <int D, class BeforeBreak, class SolveAgain>
bool settle_bonds(Increment<D>& increment, BeforeBreak&& before_break, SolveAgain&& solve_again) {
  while (increment.overloads_bonds()) {
    before_break();
    increment.break_bonds();
    if (!solve_again()) return false;
  }
  return true;
}

}  // namespace

template <int D>
bool may_fade(const Request<D>& request, const Increment<D>& increment) {
  return may_be_free(request) &&
         increment.scale().mean_force() < tuned::fading * unloaded_force(*request.problem);
}

template <int D>
const Effort& effort_of(const Request<D>& request) {
  if (request.loose_tolerance == 0) return full_effort;
  return request.guess_loose ? repeated_effort : bounded_effort;
}

template <int D>
bool solve_parts(const Request<D>& request, int parts, Workspace<D>& w, Outcome& outcome) {
  auto& increment = w.increment;
  w.sensitivity.reset();
  outcome.subincrements = parts;
  outcome.history_advanced = false;
  outcome.loose = false;
  outcome.sensitivities = request.sensitivities;
  DragStart<D> drag;
  if (has_drag(request)) drag = start_drag(request, parts, increment);
  for (int k = 1; k <= parts; ++k) {
    const double share = static_cast<double>(k) / parts;
    if (k == 1) {
      start_iteration(request, share, increment);
    } else {
      increment.deform(between<D>(request.from->deformation, request.deformation, share));
    }
    if (has_drag(request)) {
      const bool guessed = request.guess != nullptr && parts == 1;
      increment.begin_drag(drag, k == 1 ? request.from->velocity : w.velocity, !guessed);
    }
    if (!solve_part(request, w, outcome)) return false;
    double start = static_cast<double>(k - 1) / parts;
    const auto find_sensitivities = [&] {
      if (!outcome.sensitivities || (may_be_free(request) && !loaded(increment))) return;
      outcome.sensitivities = w.sensitivity.solve(increment, share, start, w.newton.stiffness);
    };
    const auto carry = [&] {
      if (!outcome.sensitivities) return;
      if (may_be_free(request) && !loaded(increment)) {
        w.sensitivity.carry_free(increment, share);
      } else {
        w.sensitivity.carry(increment);
      }
    };
    find_sensitivities();
    const bool settled = settle_bonds(increment, carry, [&] {
      start = share;
      if (!solve_part(request, w, outcome)) return false;
      find_sensitivities();
      return true;
    });
    if (!settled) return false;
    if (has_drag(request)) {
      if (outcome.sensitivities && k < parts) w.sensitivity.carry_drag(increment);
      increment.end_drag(w.velocity);
    }
    if (k < parts) {
      carry();
      increment.continue_history();
    }
  }
  if (may_be_free(request) && !loaded(increment)) outcome.sensitivities = false;
  return true;
}

template <int D>
bool solve_advancing(const Request<D>& request, Method method, Workspace<D>& w, Outcome& outcome) {
  auto& increment = w.increment;
  outcome.subincrements = 1;
  outcome.history_advanced = request.problem->law->tangential();  // else no history
  w.sensitivity.reset();
  start_iteration(request, 1, increment);
  const auto equilibrium = [&] {
    if constexpr (D == 2) {
      if (request.problem->space->options.method == BoundaryMethod::servo) {
        return solve_servo(increment, request.options->published, request.tolerance, w.reference);
      }
    }
    if (method == Method::published) {
      return relax_published(increment, request.tolerance, request.options->published, {},
                             w.reference);
    }
    increment.refresh_masses();
    const double given = given_force(increment);
    double loosest = reachable(request, increment);
    if (request.options->method == Method::direct) {
      loosest = std::max(loosest, request.loose_tolerance);
    }
    const double most_steps = (may_be_free(request) ? 2 : 1) * tuned::advancing_steps;
    const bool relaxed =
        relax(increment, loosest, relaxation_limit(most_steps, increment.problem().nodes()),
              History::advancing, w.relaxation, zero_force_share(request, increment));
    return relaxed && !exploded(request, given, increment);
  };
  const auto settled = [&] {
    if (equilibrium()) return true;
    return is_free(request, increment) && !flew_away(request, increment);
  };
  const auto nothing = [] {};
  const bool done = settled() && settle_bonds(increment, nothing, settled);
  // An F at which the contacts were lost on this path counts as loose too.
  outcome.loose =
      request.loose_tolerance > 0 && increment.residual_norm() > reachable(request, increment);
  outcome.sensitivities = done && request.sensitivities && !outcome.loose && loaded(increment) &&
                          w.sensitivity.solve(increment, 1, 0, w.newton.stiffness);
  return done;
}

template <int D>
bool solve_whole(Request<D> request, Workspace<D>& w, Outcome& outcome) {
  auto& increment = w.increment;
  request.guess = &w.detour.motion().coordinates();
  request.guess_deformation = w.detour.motion().deformation();
  start_iteration(request, 1, increment);
  increment.keep_neighbours();
  increment.update_forces();
  const int factorisations = limit_of(full_effort.first_factorisations,
                                      tuned::unsettled_factorisations, increment.problem().nodes());
  const double target = reachable(request, increment);
  if (!pseudo_transient_newton(increment, target, factorisations, w.newton, &w.relaxation))
    return false;
  if (collapsed(increment)) return false;
  w.sensitivity.reset();
  outcome.subincrements = 1;
  outcome.history_advanced = false;
  outcome.sensitivities =
      request.sensitivities && w.sensitivity.solve(increment, 1, 0, w.newton.stiffness);
  return true;
}

#define GRAINLAW_FOR(D)                                                              \
  template bool solve_parts(const Request<D>&, int, Workspace<D>&, Outcome&);        \
  template bool solve_advancing(const Request<D>&, Method, Workspace<D>&, Outcome&); \
  template bool solve_whole(Request<D>, Workspace<D>&, Outcome&);                    \
  template bool may_fade(const Request<D>&, const Increment<D>&);                    \
  template const Effort& effort_of(const Request<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
