#include "equilibrium/strategy.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw {

namespace {

constexpr int most_subincrements = 64;

// Relaxation hands over to Newton at this residual: Newton's reach shrinks with the packing's size.
double switch_tolerance(std::size_t nodes) {
  constexpr double hand_over = 5e-4;
  constexpr double exponent = 1.2;
  return hand_over * std::pow(std::min(1.0, 400.0 / static_cast<double>(nodes)), exponent);
}

// What is spent on one sub-increment with up to 400 nodes before others are tried; chosen, as what is
// named below, by `verification/run sweep`.
struct Effort {
  int rounds;                // of relaxation and Newton
  int first_factorisations;  // where Newton works at once, it works soon
  int most_factorisations;
  double relaxation_steps;
  int finest;  // sub-increments, times those that the size of the increment asks for
};
constexpr Effort full_effort{.rounds = 9,
                             .first_factorisations = 20,
                             .most_factorisations = 50,
                             .relaxation_steps = 2000,
                             .finest = 8};
constexpr Effort bounded_effort{3, 8, 20, 1000, 1};   // with a loose tolerance to end at
constexpr Effort repeated_effort{2, 8, 20, 1000, 1};  // what fluttered before seldom settles now

// Newton seldom works from where the relaxation did not settle: it is given up soon in the first
// rounds, after which another relaxation is the cheaper try.
constexpr int unsettled_factorisations = 12;
constexpr int unsettled_rounds = 2;
constexpr double advancing_steps = 75000;  // of relaxation, with up to 400 nodes

const Effort& effort_of(const Request& request) {
  if (request.loose_tolerance == 0) return full_effort;
  return request.guess_loose ? repeated_effort : bounded_effort;
}

double size_factor(std::size_t nodes) {
  return std::sqrt(std::max(1.0, static_cast<double>(nodes) / 400));
}

long relaxation_limit(double steps, std::size_t nodes) {
  return static_cast<long>(steps * size_factor(nodes));
}

// Fewer in large packings, where sub-increments cost less than to go on: in one of 6400 discs that would
// not settle all rounds took fifty times what an increment does.
int limit_of(int count, int least, std::size_t nodes) {
  const long fewer = std::lround(count / size_factor(nodes));
  return std::min(count, std::max(least, static_cast<int>(fewer)));
}

std::array<double, 4> between(const std::array<double, 9>& a, const std::array<double, 4>& b,
                              double share) {
  std::array<double, 4> f{};
  for (std::size_t k = 0; k < 4; ++k) f[k] = a[k] + share * (b[k] - a[k]);
  return f;
}

bool may_be_free(const Request& request) {
  return request.options->contacts_lost == ContactsLost::stress_free;
}

// Mean force of the packing at F = I, or what stands for it [N].
double unloaded_force(const Problem& problem) { return problem.force_floor / relative_floor; }

// Mean force below which what is left of forces that do not settle counts for nothing [N]. Bonds
// hold on without any.
double faded_force(const Request& request, const Increment& increment) {
  constexpr double loosest = 1e-6;  // of the mean force at F = I
  if (!may_be_free(request) || request.problem->law->bonds()) return 0;
  return std::max(std::min(request.tolerance, loosest) * unloaded_force(*request.problem),
                  increment.rounding_force());
}

// Without contacts there is no force to be balanced, nor where all forces fade.
bool is_free(const Request& request, Increment& increment) {
  if (!may_be_free(request)) return false;
  increment.refresh_masses();
  increment.update_forces();
  if (increment.touching == 0) return true;
  if (increment.mean_force >= faded_force(request, increment)) return false;
  increment.release_contacts();
  return true;
}

// Whether an increment that did not settle may be on its way there.
bool may_fade(const Request& request, const Increment& increment) {
  constexpr double little = 1e-2;  // of the mean force at F = I
  return may_be_free(request) && increment.mean_force < little * unloaded_force(*request.problem);
}

// Pi = |strain increment| kn / (p t), what makes an increment hard.
double hardness(const Request& request) {
  const auto& f0 = request.from->deformation;
  const auto& packing = *request.problem->packing;
  std::array<double, 4> change{};
  for (std::size_t k = 0; k < 4; ++k) change[k] = request.deformation[k] - f0[k];
  // The largest singular value, which no rotation changes.
  const double strain = 0.5 * (std::hypot(change[0] + change[3], change[1] - change[2]) +
                               std::hypot(change[0] - change[3], change[1] + change[2]));
  const auto& p = request.from->stress;
  const double det = f0[0] * f0[3] - f0[1] * f0[2];
  const double trace = p[0] * f0[0] + p[1] * f0[1] + p[2] * f0[2] + p[3] * f0[3];
  const double pressure = -0.5 * trace / det;
  double radius = 0;
  for (const double r : packing.radius) radius += r / static_cast<double>(packing.size());
  double line = std::max(pressure * packing.thickness, request.problem->force_floor / radius);
  // A free packing has no pressure to compare with: that at F = I serves.
  if (may_be_free(request)) {
    line = std::max(line, unloaded_force(*request.problem) / radius);
  }
  // Bonds hold each other in place until they break.
  if (request.problem->law->bonds()) {
    line = std::max(line, request.problem->law->bond.normal_strength / radius);
  }
  return line > 0 ? strain * request.problem->law->stiffness(radius, radius) / line : 0;
}

void start_iteration(const Request& request, double share, Increment& increment) {
  increment.begin(*request.problem, *request.from,
                  between(request.from->deformation, request.deformation, share));
  if (request.guess != nullptr && share == 1) {
    increment.coordinates = *request.guess;
    increment.deformation = request.guess_deformation;
    increment.deform(request.deformation);
  }
}

// The tolerance, and no less than rounding leaves: below that there is no equilibrium to speak of.
// Forces may fade on the way to it.
double reachable(const Request& request, const Increment& increment) {
  constexpr double loosest = 1e-3;
  return std::max(request.tolerance, std::min(increment.rounding_residual(), loosest));
}

// One sub-increment: relaxation, then Newton; when Newton does not get there, both again from where
// they are, the relaxation longer and tighter, at last down to the target itself.
bool solve_part(const Request& request, Workspace& w, Outcome& outcome) {
  constexpr double tighter = 0.3;
  constexpr double much_tighter = 0.1;
  constexpr double worth_newton = 0.5;  // a looser target is sooner reached by relaxation alone
  // After them, relaxed down to the target, one whole increment in a thousand still settles: two
  // sub-increments are cheaper.
  constexpr int enough_rounds = 6;
  constexpr int least_rounds = 3;
  const bool whole = outcome.subincrements == 1;
  auto& increment = w.increment;
  const Effort& effort = effort_of(request);
  const long steps = relaxation_limit(effort.relaxation_steps, increment.nodes());
  const auto limit_to = [&](int count, int least) {
    return limit_of(count, least, increment.nodes());
  };
  const int rounds = limit_to(effort.rounds, least_rounds);
  const int enough = limit_to(enough_rounds, least_rounds);
  const int most_factorisations = limit_to(effort.most_factorisations, unsettled_factorisations);
  increment.refresh_masses();
  double target = reachable(request, increment);
  double hand_over = switch_tolerance(increment.nodes());
  if (target > worth_newton * hand_over) hand_over = target;
  bool last = false;
  for (int round = 0; !last && round < rounds; ++round) {
    last = whole && round >= enough && hand_over <= target;
    const double tolerance = std::max(hand_over, target);
    const long limit = (round < 5 ? 1 : 2) * steps;
    // From the last iterate of a step the next is found on the same branch.
    const bool may_extrapolate = request.guess == nullptr;
    const bool relaxed =
        relax(increment, tolerance, limit, History::committed, w.relaxation, 0, may_extrapolate);
    if (increment.touching == 0 || increment.collapsed()) return is_free(request, increment);
    if (relaxed && tolerance == target) return true;
    const auto is_loose = [&] { return increment.residual_norm() < request.loose_tolerance; };
    if (request.guess_loose && !relaxed && is_loose()) return outcome.loose = true;
    const bool unsettled = !relaxed && round < unsettled_rounds;
    const int factorisations = unsettled    ? unsettled_factorisations
                               : round == 0 ? effort.first_factorisations
                                            : most_factorisations;
    // What is fading away settles nowhere.
    auto* const settling = may_fade(request, increment) ? nullptr : &w.relaxation;
    if (pseudo_transient_newton(increment, target, factorisations, w.newton, settling)) return true;
    const bool too_soon = round == 0 && !request.guess_loose;
    if (!too_soon && is_loose()) return outcome.loose = true;
    hand_over *= round < 2 ? tighter : much_tighter;
    target = reachable(request, increment);
  }
  return is_free(request, increment);
}

// Once at equilibrium, break the bonds that are beyond their strength and find the next one at the
// same F, until none is: `solve_again` does, after `before_break`.
template <class BeforeBreak, class SolveAgain>
bool settle_bonds(Increment& increment, BeforeBreak&& before_break, SolveAgain&& solve_again) {
  while (increment.overloads_bonds()) {
    before_break();
    increment.break_bonds();
    if (!solve_again()) return false;
  }
  return true;
}

bool solve_parts(const Request& request, int parts, Workspace& w, Outcome& outcome) {
  auto& increment = w.increment;
  w.sensitivity.reset();
  outcome.subincrements = parts;
  outcome.history_advanced = false;
  outcome.loose = false;
  outcome.sensitivities = request.sensitivities;
  for (int k = 1; k <= parts; ++k) {
    const double share = static_cast<double>(k) / parts;
    if (k == 1) {
      start_iteration(request, share, increment);
    } else {
      increment.deform(between(request.from->deformation, request.deformation, share));
    }
    if (!solve_part(request, w, outcome)) return false;
    double start = static_cast<double>(k - 1) / parts;
    const auto find_sensitivities = [&] {
      if (!outcome.sensitivities || (may_be_free(request) && !increment.bears())) return;
      outcome.sensitivities = w.sensitivity.solve(increment, share, start, w.newton.stiffness);
    };
    const auto carry = [&] {
      if (!outcome.sensitivities) return;
      if (may_be_free(request) && !increment.bears()) {
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
    if (k < parts) {
      carry();
      increment.continue_history();
    }
  }
  return true;
}

// Relaxation with advancing history, by the method asked for.
bool solve_advancing(const Request& request, Method method, Workspace& w, Outcome& outcome) {
  auto& increment = w.increment;
  outcome.subincrements = 1;
  outcome.history_advanced = request.problem->law->tangential();  // else there is none
  w.sensitivity.reset();
  start_iteration(request, 1, increment);
  const auto equilibrium = [&] {
    if (request.problem->space->options.method == BoundaryMethod::servo) {
      return solve_servo(increment, *request.options, request.tolerance, w.relaxation);
    }
    if (method == Method::published) {
      return relax_published(increment, request.tolerance, request.options->published, {},
                             w.relaxation);
    }
    increment.refresh_masses();
    double loosest = reachable(request, increment);
    if (request.options->method == Method::chain) {
      loosest = std::max(loosest, request.loose_tolerance);
    }
    const double most_steps = (may_be_free(request) ? 2 : 1) * advancing_steps;
    return relax(increment, loosest, relaxation_limit(most_steps, increment.nodes()),
                 History::advancing, w.relaxation, faded_force(request, increment));
  };
  const auto settled = [&] { return equilibrium() || is_free(request, increment); };
  const bool done = settled() && settle_bonds(
                                     increment, [] {}, settled);
  // Counts as such too: an F at which the contacts were lost this way.
  outcome.loose =
      request.loose_tolerance > 0 && increment.residual_norm() > reachable(request, increment);
  outcome.sensitivities = done && request.sensitivities && !outcome.loose && increment.bears() &&
                          w.sensitivity.solve(increment, 1, 0, w.newton.stiffness);
  return done;
}

// Whether the end of a detour may be compared with the increment as a whole: nothing broke or came free
// on the way.
bool may_be_whole(const Request& request) {
  return request.loose_tolerance == 0 && !request.problem->law->bonds() && !may_be_free(request);
}

// The equilibrium of the increment as a whole, from the committed history, near where the detour ended:
// about every other one that was missed at first is found so.
bool solve_whole(Request request, Workspace& w, Outcome& outcome) {
  auto& increment = w.increment;
  request.guess = &w.detour.coordinates;
  request.guess_deformation = w.detour.deformation;
  start_iteration(request, 1, increment);
  increment.keep_neighbours();
  increment.update_forces();
  const int factorisations =
      limit_of(full_effort.first_factorisations, unsettled_factorisations, increment.nodes());
  const double target = reachable(request, increment);
  if (!pseudo_transient_newton(increment, target, factorisations, w.newton, &w.relaxation))
    return false;
  if (increment.collapsed()) return false;
  w.sensitivity.reset();
  outcome.subincrements = 1;
  outcome.history_advanced = false;
  outcome.sensitivities =
      request.sensitivities && w.sensitivity.solve(increment, 1, 0, w.newton.stiffness);
  return true;
}

}  // namespace

Outcome solve(const Request& request, Workspace& w) {
  Outcome outcome;
  long steps = 0;
  long corrections = 0;
  int factorisations = 0;
  const auto count = [&] {
    steps += w.increment.relaxation_steps;
    corrections += w.increment.servo_corrections;
    factorisations += w.increment.factorisations;
  };
  const auto attempt = [&](bool done) {
    count();
    done = done && !w.increment.collapsed();
    if (done) outcome.status = GRAINLAW_OK;
    return done;
  };

  const double pi = hardness(request);
  const int parts =
      std::max(1, static_cast<int>(std::min<double>(
                      std::ceil(pi / request.options->increment_limit), most_subincrements)));
  const auto chain = [&] {
    if (request.options->method != Method::chain) {
      return attempt(solve_advancing(request, request.options->method, w, outcome));
    }
    // What ended so before in this step would seldom end otherwise now.
    const bool advance_first = request.guess_advanced && request.guess_loose;
    if (advance_first && attempt(solve_advancing(request, Method::advancing, w, outcome))) {
      return true;
    }
    const auto straighten = [&] {
      if (parts > 1 || !may_be_whole(request)) return;
      w.detour = w.increment;
      const bool whole = solve_whole(request, w, outcome);
      count();
      if (!whole) std::swap(w.increment, w.detour);
    };
    const int finest = effort_of(request).finest;
    bool fallback_left = true;
    for (int refinement = 1; refinement <= finest; refinement *= 2) {
      if (parts * refinement > most_subincrements) break;
      if (attempt(solve_parts(request, parts * refinement, w, outcome))) {
        if (refinement > 1) straighten();
        return true;
      }
      if (w.increment.touching == 0 || w.increment.collapsed()) return false;
      if (refinement == 1 && finest > 1 && may_fade(request, w.increment)) {
        fallback_left = solve_advancing(request, Method::advancing, w, outcome);
        if (attempt(fallback_left && !w.increment.bears())) return true;
      }
    }
    if (!fallback_left || !attempt(solve_advancing(request, Method::advancing, w, outcome))) {
      return false;
    }
    straighten();
    return true;
  };
  if (!chain()) {
    outcome.status = w.increment.collapsed()     ? GRAINLAW_COLLAPSED
                     : w.increment.touching == 0 ? GRAINLAW_CONTACTS_LOST
                                                 : GRAINLAW_NOT_CONVERGED;
    outcome.step_ratio = 0.5;
  }
  w.increment.relaxation_steps = steps;
  w.increment.servo_corrections = corrections;
  w.increment.factorisations = factorisations;
  return outcome;
}

}  // namespace grainlaw
