// The published servo for frames (Liu, Bosco & Suiker 2017, Tables 2 and 3): boundary nodes are
// moved by gain x residual between relaxations of the inner particles.
#pragma once

#include "reference/local_damping.hpp"

namespace grainlaw::core {

bool solve_servo(Increment<2>& increment, const PublishedOptions& options, double tolerance,
                 ReferenceMemory& memory);

}  // namespace grainlaw::core
