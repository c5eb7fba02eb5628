#include "material/initial_stress.hpp"

#include "base/error.hpp"
#include "homogenise/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainlaw {

namespace {

// Of the way from the stress at F = I to the prescribed one.
constexpr double first_step = 0.1;
constexpr double least_step = 1e-3;

std::array<double, 4> between(const std::array<double, 9>& from, const BoundarySpace& space,
                              double share) {
  std::array<double, 4> stress{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (space.found[k]) stress[k] = from[k] + share * (space.stress[k] - from[k]);
  }
  return stress;
}

}  // namespace

void load_to_stress(const BoundarySpace& space, const Request& request, Workspace& workspace,
                    Configuration& at) {
  BoundarySpace loading = space;
  loading.options.method = BoundaryMethod::direct;
  Problem problem = *request.problem;
  problem.space = &loading;
  const auto from = at.stress;
  double share = 0;
  double step = first_step;
  while (share < 1) {
    const double next = std::min(1.0, share + step);
    loading.stress = between(from, space, next);
    Request part = request;
    part.problem = &problem;
    part.from = &at;
    std::copy_n(at.deformation.begin(), 4, part.deformation.begin());
    const auto outcome = solve(part, workspace);
    if (outcome.status == GRAINLAW_OK && workspace.increment.bears()) {
      const auto stress = piola_stress(workspace.increment);
      workspace.increment.advance_history();
      Configuration reached;
      workspace.increment.export_to(at, reached);
      std::copy_n(stress.begin(), 4, reached.stress.begin());
      reached.dissipated = reached.broken_bonds = 0;
      at = std::move(reached);
      share = next;
      step = std::min(2 * step, first_step);
      continue;
    }
    step *= 0.5;
    if (step >= least_step) continue;
    std::string prescribed;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!space.found[k]) continue;
      prescribed +=
          fmt::format("{}P{}{} = {:.6g} Pa (reached {:.6g} Pa)", prescribed.empty() ? "" : ", ",
                      k / 2 + 1, k % 2 + 1, space.stress[k], at.stress[k]);
    }
    const auto status = outcome.status == GRAINLAW_OK ? GRAINLAW_CONTACTS_LOST : outcome.status;
    throw Error(GRAINLAW_NOT_CONVERGED,
                fmt::format("boundary.stress: no state of the packing carries {}: {}", prescribed,
                            grainlaw_status_text(status)));
  }
}

}  // namespace grainlaw
