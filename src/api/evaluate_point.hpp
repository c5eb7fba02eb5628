// One checked evaluation, shared by the single and the batch call.
#pragma once

#include "api/handle.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>

namespace grainlaw::api {

// None or one known bit of GRAINLAW_WANT_*.
[[nodiscard]] bool known_want(unsigned want);

// The state is alive, want and the report's size are known; F, P, A as in grainlaw_evaluate, report
// may be null. Never throws. Unless it returns OK the state has no trial, so that a host that
// overlooks the status cannot commit an earlier one.
grainlaw_status evaluate_point(grainlaw_state& handle, const double* F, unsigned want, double* P,
                               double* A, void* report) noexcept;

}  // namespace grainlaw::api
