// Workspace with which a thread evaluates.
#pragma once

#include "equilibrium/strategy.hpp"

namespace grainlaw::core {

// Workspace of the calling thread: created by its first evaluation, reused, freed with the thread.
// Throws bad_alloc.
template <int D>
Workspace<D>& workspace();

// Frees the thread's workspace, which an exception leaves half done.
template <int D>
void drop_workspace() noexcept;

}  // namespace grainlaw::core
