// One checked evaluation, for calls with one point or many.
#pragma once

#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

#include <string>

namespace grainlaw::core::api {

// Whether `want` is zero or one known bit of GRAINLAW_WANT_*.
[[nodiscard]] bool known_want(unsigned want);
// What is wrong with an unknown one.
[[nodiscard]] std::string fault_of_want(unsigned want);

// The tangent of a known `want`.
[[nodiscard]] TangentKind tangent_kind(unsigned want);

// Evaluates a point; `want` is known, F, P, A as in grainlaw_evaluate. Overwrites the report; never
// throws. Any status but OK leaves no trial, so that a host that ignores the status cannot commit
// an earlier one.
grainlaw_status evaluate_point(IntegrationPoint& point, const double* F, unsigned want, double* P,
                               double* A, grainlaw_report& report) noexcept;

}  // namespace grainlaw::core::api
