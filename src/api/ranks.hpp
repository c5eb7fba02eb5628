// Agreement of the ranks of a host on the failures of their sets.
#pragma once

#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

namespace grainlaw::core::api {

// The host's reduction over its ranks; without one a set is alone.
struct Ranks {
  grainlaw_reduce reduce = nullptr;
  void* context = nullptr;
  int rank = -1;
};

// Replaces a summary by that of all ranks, of their points together. Returns the rank of the first
// failed point; -1 when there is none or the set is alone.
int agree(const Ranks& ranks, Summary& summary);

// True if all ranks say so.
bool agree(const Ranks& ranks, bool mine);

}  // namespace grainlaw::core::api
