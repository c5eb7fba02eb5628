// An order of particles in which neighbours are near each other in memory.
#pragma once

#include "packing/packing.hpp"

#include <cstdint>
#include <vector>

namespace grainlaw::core {

// Serpentine order along rows of the cell, each two particles high. Empty for packings whose
// records fit in the first-level cache.
std::vector<std::int32_t> row_order(const Packing& packing);

}  // namespace grainlaw::core
