#include "api/evaluate_point.hpp"

#include "api/guard.hpp"

#include <fmt/format.h>

namespace grainlaw::core::api {

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

bool known_want(unsigned want) {
  return want == 0 || want == GRAINLAW_WANT_TANGENT_EXACT ||
         want == GRAINLAW_WANT_TANGENT_ELASTIC || want == GRAINLAW_WANT_TANGENT_PERTURBED;
}

std::string fault_of_want(unsigned want) {
  return fmt::format("want is {}, expected 0 or one of GRAINLAW_WANT_TANGENT_*: {}, {} or {}", want,
                     static_cast<int>(GRAINLAW_WANT_TANGENT_EXACT),
                     static_cast<int>(GRAINLAW_WANT_TANGENT_ELASTIC),
                     static_cast<int>(GRAINLAW_WANT_TANGENT_PERTURBED));
}

grainlaw_status evaluate_point(IntegrationPoint& point, const double* F, unsigned want, double* P,
                               double* A, grainlaw_report& report) noexcept {
  report = grainlaw_report_default();
  const MessageBuffer message{report.message, sizeof report.message};
  const grainlaw_status status = guarded(
      [&] {
        point.state.check_deformation(F);
        const TangentKind kind = A == nullptr ? TangentKind::none : tangent_kind(want);
        return point.evaluate(F, kind, P, A, report);
      },
      message);
  if (status != GRAINLAW_OK) point.state.revert();
  const bool suggests = report.step_ratio > 0 && report.step_ratio < 1;
  if (status > GRAINLAW_OK && !suggests) report.step_ratio = 0.5;
  return status;
}

}  // namespace grainlaw::core::api
