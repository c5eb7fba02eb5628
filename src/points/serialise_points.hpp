// The committed states of many points as bytes and back: all of them, or none.
#pragma once

#include "points/points.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core {

// Bytes that these points take.
[[nodiscard]] std::size_t saved_size(PointSpan points);

// Fills bytes, of saved_size.
void save_points(PointSpan points, std::span<std::byte> bytes);

// Replaces what is committed and drops the trials. Any bytes of any length may be given. Throws
// Error (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL; BAD_ARGUMENT for another number of points) or
// bad_alloc, and then has changed nothing.
void load_points(PointSpan points, std::span<const std::byte> bytes);

}  // namespace grainlaw::core
