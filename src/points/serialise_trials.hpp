// Trials of points as bytes, for another process that evaluates a point or gives back what it found.
#pragma once

#include "points/points.hpp"
#include "points/serialise_points.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core {

// Size of the trial of a point in bytes, with its tangent and its cost. Unless `evaluated` it is
// what the next trial starts from.
[[nodiscard]] std::size_t saved_trial_size(const IntegrationPoint& point, bool evaluated);

// Writes saved_trial_size() bytes.
void save_trial(const IntegrationPoint& point, bool evaluated, std::span<std::byte> bytes);

// Loads one trial into each point. Throws Error (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL), with the
// number of the point from `number_of`, or bad_alloc, and then changes nothing.
void load_trials(PointSpan points, std::span<const std::span<const std::byte>> bytes,
                 const NumberOf& number_of);

}  // namespace grainlaw::core
