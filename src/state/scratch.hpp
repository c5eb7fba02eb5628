// The memory with which a thread evaluates.
#pragma once

#include "equilibrium/strategy.hpp"

namespace grainlaw::core {

// Of the calling thread: made by its first evaluation, reused by the next, gone with the thread.
// Throws bad_alloc.
template <int D>
Workspace<D>& workspace();

// Frees it: what an exception left half done serves nobody.
template <int D>
void drop_workspace() noexcept;

}  // namespace grainlaw::core
