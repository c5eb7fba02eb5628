#include "generate/regular.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace grainlaw::core {

namespace {

// Rows at distance `height`, every second one shifted by `stagger`.
Packing lattice(std::size_t columns, std::size_t rows, double radius, double distance,
                double height, double stagger) {
  const auto require = [](bool right, const char* name, double value, const char* expected) {
    if (!right)
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("generator: {} = {}, expected {}", name, value, expected));
  };
  constexpr std::size_t most = 10000;
  require(columns >= 2 && columns <= most, "columns", static_cast<double>(columns), "2 to 10000");
  require(rows >= 2 && rows <= most, "rows", static_cast<double>(rows), "2 to 10000");
  require(radius > 0 && std::isfinite(radius), "radius", radius, "a length > 0");
  require(distance > radius && distance <= 2 * radius, "distance of neighbours", distance,
          "more than the radius and at most the diameter");
  Packing packing;
  packing.cell = {static_cast<double>(columns) * distance, 0, 0,
                  static_cast<double>(rows) * height};
  packing.radius.assign(columns * rows, radius);
  std::vector<double> y;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      // A quarter of a distance from the cell's edges, so that rounding cannot carry a disc across.
      packing.position.push_back((static_cast<double>(column) + 0.25) * distance +
                                 (row % 2 == 1 ? stagger : 0));
      y.push_back((static_cast<double>(row) + 0.25) * height);
    }
  packing.position.insert(packing.position.end(), y.begin(), y.end());
  return packing;
}

}  // namespace

Packing square_lattice(std::size_t columns, std::size_t rows, double radius, double distance) {
  return lattice(columns, rows, radius, distance, distance, 0);
}

Packing hexagonal_lattice(std::size_t columns, std::size_t rows, double radius, double distance) {
  if (rows % 2 != 0)
    throw Error(GRAINLAW_BAD_PACKING,
                fmt::format("generator: rows = {}, expected an even number of rows in a hexagonal "
                            "packing",
                            rows));
  return lattice(columns, rows, radius, distance, distance * 0.5 * std::numbers::sqrt3,
                 0.5 * distance);
}

}  // namespace grainlaw::core
