// Committed states of points as bytes, loaded all or none.
#pragma once

#include "points/points.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// What bytes hold of a point.
struct SavedPoint {
  SavedState state;
  KeptTangent tangent;
};

// Size of a saved point in bytes: of its state, and of its tangent where it has one.
[[nodiscard]] std::size_t saved_size(const IntegrationPoint& point);

// Writes saved_size(point) bytes.
void save_point(const IntegrationPoint& point, std::span<std::byte> bytes);

// Reads any bytes of any length. Throws Error (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL) or
// bad_alloc.
[[nodiscard]] SavedPoint read_point(const IntegrationPoint& point,
                                    std::span<const std::byte> bytes);

// Makes a saved point the committed one and drops the trial.
void restore_point(IntegrationPoint& point, SavedPoint saved) noexcept;

// Loads one saved point into each. Throws as read_point() does, with the number of the point from
// `number_of`, and then changes nothing.
using NumberOf = std::function<std::size_t(std::size_t k)>;
void load_each(PointSpan points, std::span<const std::span<const std::byte>> bytes,
               const NumberOf& number_of);

// Size of the saved points of a set in bytes.
[[nodiscard]] std::size_t saved_size(PointSpan points);

// Writes saved_size(points) bytes.
void save_points(PointSpan points, std::span<std::byte> bytes);

// Replaces the committed states and drops the trials; accepts any bytes of any length. Throws Error
// (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL; BAD_ARGUMENT for another number of points) or
// bad_alloc, and then changes nothing.
void load_points(PointSpan points, std::span<const std::byte> bytes);

}  // namespace grainlaw::core
