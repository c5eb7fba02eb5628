// One checked evaluation, shared by the calls for one point and for many.
#pragma once

#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

namespace grainlaw::core::api {

// None or one known bit of GRAINLAW_WANT_*.
[[nodiscard]] bool known_want(unsigned want);

// want is known; F, P, A as in grainlaw_evaluate. Fills the report, whatever is in it. Never throws.
// Unless it returns OK the state has no trial, so that a host that overlooks the status cannot commit
// an earlier one.
grainlaw_status evaluate_point(IntegrationPoint& point, const double* F, unsigned want, double* P,
                               double* A, grainlaw_report& report) noexcept;

}  // namespace grainlaw::core::api
