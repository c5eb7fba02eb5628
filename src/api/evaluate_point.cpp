#include "api/evaluate_point.hpp"

#include "api/guard.hpp"
#include "api/report.hpp"
#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainlaw::api {
namespace {

// What a factorisation costs in relaxation steps: some tens of them with hundreds of particles.
constexpr long steps_per_factorisation = 50;

// Throws Error (NOT_FINITE, INVERTED, STEP_TOO_LARGE when the determinant overflows).
template <int D>
void check_deformation(const Tensor<D>& F) {
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t j = 0; j < D; ++j)
      if (const double entry = F[i * D + j]; !std::isfinite(entry))
        throw Error(GRAINLAW_NOT_FINITE, fmt::format("F{}{} is {}", i + 1, j + 1, entry));
  const double det = determinant<D>(F);
  if (!std::isfinite(det)) throw Error(GRAINLAW_STEP_TOO_LARGE, "det F overflows");
  if (det <= 0) throw Error(GRAINLAW_INVERTED, fmt::format("det F = {:.6g}, expected > 0", det));
}

TangentKind tangent_kind(unsigned want) {
  switch (want) {
    case GRAINLAW_WANT_TANGENT_EXACT:
      return TangentKind::exact;
    case GRAINLAW_WANT_TANGENT_ELASTIC:
      return TangentKind::elastic;
    case GRAINLAW_WANT_TANGENT_PERTURBED:
      return TangentKind::perturbed;
    default:
      return TangentKind::none;
  }
}

}  // namespace

bool known_want(unsigned want) {
  return want == 0 || want == GRAINLAW_WANT_TANGENT_EXACT ||
         want == GRAINLAW_WANT_TANGENT_ELASTIC || want == GRAINLAW_WANT_TANGENT_PERTURBED;
}

grainlaw_status evaluate_point(grainlaw_state& handle, const double* F, unsigned want, double* P,
                               double* A, void* report) noexcept {
  grainlaw_report full = grainlaw_report_default();
  const MessageBuffer message{full.message, sizeof full.message};
  const grainlaw_status status = guarded(
      [&] {
        check_deformation<2>(handle.state.effective(F));
        const TangentKind kind = A == nullptr ? TangentKind::none : tangent_kind(want);
        const grainlaw_status found = handle.state.evaluate(F, kind, P, A, full);
        handle.last_cost = full.relaxation_steps + steps_per_factorisation * full.factorisations;
        return found;
      },
      message);
  if (status != GRAINLAW_OK) handle.state.revert();
  const bool suggests = full.step_ratio > 0 && full.step_ratio < 1;
  if (status > GRAINLAW_OK && !suggests) full.step_ratio = 0.5;
  if (report != nullptr) copy_report(full, report);
  return status;
}

}  // namespace grainlaw::api
