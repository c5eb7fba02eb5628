// Particles in an order in which neighbours are near each other in memory.
#pragma once

#include "packing/packing.hpp"

#include <cstdint>
#include <vector>

namespace grainlaw::core {

// To and fro along rows of the cell, each two particles high. Empty for packings so small that their
// records stay in the first cache anyway.
std::vector<std::int32_t> row_order(const Packing& packing);

}  // namespace grainlaw::core
