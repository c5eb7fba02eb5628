#include "material/initial_stress.hpp"

#include "base/error.hpp"
#include "homogenise/stress.hpp"
#include "increment/contact_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

// First step, as a share of the way from the stress at F = I to the prescribed one.
constexpr double first_step = 0.1;
constexpr double least_step = 1e-2;
constexpr int most_advancing_steps = 8;
constexpr double infinity = std::numeric_limits<double>::infinity();

template <int D>
Tensor<D> between(const Tensor<D>& from, const BoundarySpace<D>& space, double share) {
  Tensor<D> stress{};
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) stress[k] = from[k] + share * (space.stress[k] - from[k]);
  }
  return stress;
}

}  // namespace

template <int D>
void load_to_stress(const BoundarySpace<D>& space, const Request<D>& request,
                    Workspace<D>& workspace, Configuration<D>& at) {
  BoundarySpace<D> loading = space;
  loading.options.method = BoundaryMethod::direct;
  Problem<D> problem = *request.problem;
  problem.space = &loading;
  const auto from = at.stress;
  double share = 0;
  double missed = infinity;  // smallest share that failed from here
  double step = first_step;
  bool advancing = false;
  int advancing_steps = 0;
  long relaxation_steps = 0;
  while (share < 1) {
    const double next = std::min(1.0, share + step);
    loading.stress = between<D>(from, space, next);
    Request<D> part = request;
    part.problem = &problem;
    part.from = &at;
    part.deformation = at.deformation;
    part.trying = advancing ? Trying::advancing : Trying::committed;
    const auto outcome = solve(part, workspace);
    relaxation_steps += workspace.increment.cost.relaxation_steps;
    if (outcome.status == GRAINLAW_OK && loaded(workspace.increment)) {
      const auto stress = piola_stress(workspace.increment);
      workspace.increment.advance_history();
      Configuration<D> reached;
      workspace.increment.export_to(at, reached);
      reached.stress = stress;
      reached.dissipated = 0;
      at = std::move(reached);
      share = next;
      advancing = false;
      if (share >= missed) missed = infinity;
      if (share + 2 * step < missed) step = std::min(2 * step, first_step);
      continue;
    }
    missed = std::min(missed, next);
    if (0.5 * step >= least_step) {
      step *= 0.5;
      continue;
    }
    if (!advancing && advancing_steps < most_advancing_steps) {
      advancing = true;
      ++advancing_steps;
      continue;
    }
    std::string prescribed;
    for (std::size_t k = 0; k < squared<D>; ++k) {
      if (!space.found[k]) continue;
      prescribed +=
          fmt::format("{}P{}{} = {:.6g} Pa (reached {:.6g} Pa)", prescribed.empty() ? "" : ", ",
                      k / D + 1, k % D + 1, space.stress[k], at.stress[k]);
    }
    const bool lost = outcome.status == GRAINLAW_OK || outcome.status == GRAINLAW_CONTACTS_LOST;
    throw Error(
        GRAINLAW_NOT_CONVERGED,
        fmt::format(
            "boundary.stress: no state of the packing carries {}: {} after {} relaxation steps",
            prescribed, lost ? "contacts are lost" : "no equilibrium is found", relaxation_steps));
  }
}

template void load_to_stress(const BoundarySpace<2>&, const Request<2>&, Workspace<2>&,
                             Configuration<2>&);
template void load_to_stress(const BoundarySpace<3>&, const Request<3>&, Workspace<3>&,
                             Configuration<3>&);

}  // namespace grainlaw::core
