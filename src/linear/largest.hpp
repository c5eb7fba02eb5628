// Largest entries of vectors over nodes.
#pragma once

#include <cstddef>

namespace grainlaw::core {

// Finds the largest magnitude by lane of `count` registers of `width` doubles, 4 or 8. It is
// infinite if a number is not finite.
template <std::size_t width>
void largest_by_lane(const double* values, std::size_t count, double* result);

}  // namespace grainlaw::core
