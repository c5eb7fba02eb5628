// Committed states of many points as bytes, loaded all or none.
#pragma once

#include "points/points.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core {

// Size of the saved points in bytes.
[[nodiscard]] std::size_t saved_size(PointSpan points);

// Writes saved_size(points) bytes.
void save_points(PointSpan points, std::span<std::byte> bytes);

// Replaces the committed states and drops the trials; accepts any bytes of any length. Throws Error
// (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL; BAD_ARGUMENT for another number of points) or
// bad_alloc, and then changes nothing.
void load_points(PointSpan points, std::span<const std::byte> bytes);

}  // namespace grainlaw::core
