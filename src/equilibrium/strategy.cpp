#include "equilibrium/strategy.hpp"

#include "base/constants.hpp"
#include "base/error.hpp"
#include "equilibrium/stages.hpp"
#include "increment/contact_state.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace grainlaw::core {

namespace {

// Hardness of an increment [-]. @formula hardness
template <int D>
double hardness(const Request<D>& request) {
  const auto& f0 = request.from->deformation;
  const auto& packing = *request.problem->packing;
  Tensor<D> change{};
  for (std::size_t k = 0; k < squared<D>; ++k) change[k] = request.deformation[k] - f0[k];
  const double strain = largest_singular_value<D>(change);
  const auto& p = request.from->stress;
  double work = p[0] * f0[0];
  for (std::size_t k = 1; k < squared<D>; ++k) work += p[k] * f0[k];
  const double pressure = -1.0 / D * work / determinant<D>(f0);
  const double radius = mean_radius(packing.radius);
  double line = std::max(pressure * depth<D>(packing), request.problem->force_floor / radius);
  // A packing without stress has no pressure to compare with; the pressure at F = I replaces it.
  if (may_be_free(request)) {
    line = std::max(line, unloaded_force(*request.problem) / radius);
  }
  // Bonds support each other up to their strength.
  if (request.problem->law->bonds()) {
    line = std::max(line, request.problem->law->bond.normal_strength / radius);
  }
  return line > 0 ? strain * request.problem->law->largest_stiffness(radius, radius) / line : 0;
}

// Number of sub-increments that the size of the increment requires.
template <int D>
int least_parts(const Request<D>& request) {
  const double asked = std::ceil(hardness(request) / request.options->increment_limit);
  return asked >= 1 ? static_cast<int>(std::min<double>(asked, tuned::most_subincrements)) : 1;
}

struct Stage {
  enum Kind {
    as_asked,   // by the method of the material
    parts,      // sub-increments
    fading,     // advancing history; succeeds only if all forces fade
    advancing,  // advancing history; any end succeeds
  } kind;
  int number = 1;          // of sub-increments
  bool try_whole = false;  // afterwards try the whole increment from this end
};

// Stages in the order in which they are tried.
class Stages {
 public:
  template <int D>
  explicit Stages(const Request<D>& request) {
    if (request.options->method != Method::direct) {
      add({Stage::as_asked});
      return;
    }
    if (request.trying != Trying::all) {
      if (request.trying != Trying::advancing) add({Stage::parts});
      if (request.trying == Trying::committed) return;
      add({Stage::fading});
      add({Stage::advancing});
      return;
    }
    if (request.problem->inertia) {  // one step: the host cuts its own time
      add({Stage::parts});
      return;
    }
    const Viscosity& viscosity = request.options->viscosity;
    if (viscosity.number > 0) {
      // P depends a little on the number of parts, so that number is constant in F as long as it
      // converges.
      const int steps = static_cast<int>(viscosity.steps);
      add({Stage::parts, steps});
      const int least = std::max(steps, least_parts(request));
      for (int refinement = least > steps ? 1 : 2; refinement <= tuned::finest_refinement;
           refinement *= 2) {
        if (least * refinement <= tuned::most_subincrements) {
          add({Stage::parts, least * refinement});
        }
      }
      return;
    }
    // An increment that ended so before in this step would rarely end otherwise now.
    if (request.guess_advanced && request.guess_loose) add({Stage::advancing});
    const int least = least_parts(request);
    const int finest = effort_of(request).finest;
    // Comparison with the whole increment is sound only if no bond broke and no contact was
    // released on the way.
    const bool whole = least == 1 && request.loose_tolerance == 0 &&
                       !request.problem->law->bonds() && !may_be_free(request);
    for (int refinement = 1; refinement <= finest; refinement *= 2) {
      if (least * refinement > tuned::most_subincrements) break;
      add({Stage::parts, least * refinement, whole && refinement > 1});
      if (refinement == 1 && finest > 1) add({Stage::fading});
    }
    add({Stage::advancing, 1, whole});
  }

  [[nodiscard]] const Stage* begin() const { return stages_.data(); }
  [[nodiscard]] const Stage* end() const { return stages_.data() + size_; }

 private:
  void add(const Stage& stage) { stages_[size_++] = stage; }

  static constexpr std::size_t most = 4 + 8;  // refinements are powers of two
  std::array<Stage, most> stages_{};
  std::size_t size_ = 0;
};

// Tries the stages until one ends in an equilibrium.
template <int D>
class Walk {
 public:
  Walk(const Request<D>& request, Workspace<D>& workspace)
      : request_(request), workspace_(workspace) {}

  Outcome run() {
    if (!find()) {
      if (ran_away_) std::rethrow_exception(ran_away_);
      const auto& increment = workspace_.increment;
      outcome_.status = collapsed(workspace_.increment) ? GRAINLAW_COLLAPSED
                        : !increment.held()             ? GRAINLAW_CONTACTS_LOST
                                                        : GRAINLAW_NOT_CONVERGED;
      outcome_.step_ratio = 0.5;
    }
    workspace_.increment.cost = cost_;
    return outcome_;
  }

 private:
  bool find() {
    bool advancing_fails = false;
    for (const Stage& stage : Stages(request_)) {
      auto& increment = workspace_.increment;
      if (stage.kind == Stage::fading && !may_fade(request_, increment)) continue;
      if (stage.kind == Stage::advancing && advancing_fails) return false;
      const bool done = enter(stage);
      if (stage.kind == Stage::fading) advancing_fails = !done;
      if (ran_away_) continue;
      const bool accepted = done && (stage.kind != Stage::fading || !loaded(increment));
      cost_.add(increment.cost);
      if (accepted && !collapsed(increment)) {
        outcome_.status = GRAINLAW_OK;
        if (stage.try_whole) try_whole();
        return true;
      }
      if (stage.kind == Stage::parts && lost(increment)) return false;
      if (request_.trying == Trying::whole && increment.scale().below_rounding()) return false;
    }
    return false;
  }

  // A guess from which positions run away is dropped for the committed start.
  bool enter(const Stage& stage) {
    bool done = attempt([&] { return go(stage); });
    if (ran_away_ && request_.guess != nullptr) {
      request_.guess = nullptr;
      done = attempt([&] { return go(stage); });
    }
    return done;
  }

  bool go(const Stage& stage) {
    switch (stage.kind) {
      case Stage::as_asked:
        return solve_advancing(request_, request_.options->method, workspace_, outcome_);
      case Stage::parts:
        return solve_parts(request_, stage.number, workspace_, outcome_);
      case Stage::fading:
      case Stage::advancing:
        return solve_advancing(request_, Method::advancing, workspace_, outcome_);
    }
    return false;
  }

  // Whether it ended in an equilibrium; positions that run away are none.
  template <class Action>
  bool attempt(Action&& action) {
    ran_away_ = nullptr;
    try {
      return action();
    } catch (const Error& error) {
      if (error.status != GRAINLAW_NOT_CONVERGED) throw;
      ran_away_ = std::current_exception();
      return false;
    }
  }

  void try_whole() {
    workspace_.detour = workspace_.increment;
    const bool whole = attempt([&] { return solve_whole(request_, workspace_, outcome_); });
    cost_.add(workspace_.increment.cost);
    if (!whole) std::swap(workspace_.increment, workspace_.detour);
  }

  Request<D> request_;
  Workspace<D>& workspace_;
  Outcome outcome_;
  Cost cost_;                    // of all stages together
  std::exception_ptr ran_away_;  // of the last attempt, when positions did
};

}  // namespace

template <int D>
Outcome solve(const Request<D>& request, Workspace<D>& workspace) {
  return Walk<D>(request, workspace).run();
}

template Outcome solve(const Request<2>&, Workspace<2>&);
template Outcome solve(const Request<3>&, Workspace<3>&);

}  // namespace grainlaw::core
