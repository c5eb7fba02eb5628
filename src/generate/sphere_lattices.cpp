#include "generate/sphere_lattices.hpp"

#include "generate/generator_checks.hpp"
#include "math/tensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainlaw::core {

namespace {

struct UnitCell {
  Vec<3> edges;                   // of a cell, over the distance of neighbours
  std::vector<Vec<3>> positions;  // positions over the edges
  int neighbours;
};

UnitCell unit_cell(GeneratorKind kind) {
  const auto cube = [](double edge) { return Vec<3>{edge, edge, edge}; };
  switch (kind) {
    case GeneratorKind::bcc:
      return {cube(2 / std::numbers::sqrt3), {{0, 0, 0}, {0.5, 0.5, 0.5}}, 8};
    case GeneratorKind::fcc:
      return {
          cube(std::numbers::sqrt2), {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}, 12};
    case GeneratorKind::hcp:
      return {{1, std::numbers::sqrt3, std::sqrt(8.0 / 3)},
              {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 1.0 / 6, 0.5}, {0, 2.0 / 3, 0.5}},
              12};
    default:
      return {cube(1), {{0, 0, 0}}, 6};
  }
}

}  // namespace

Packing sphere_lattice(GeneratorKind kind, const std::array<std::size_t, 3>& cells, double radius,
                       double distance) {
  constexpr std::size_t most = 100;
  for (const std::size_t count : cells) {
    if (count < 1 || count > most) wrong("cells", static_cast<double>(count), "1 to 100");
  }
  if (!(radius > 0) || !std::isfinite(radius)) wrong("radius", radius, "a length > 0");
  const double least = 2 * radius * (1 - most_lattice_overlap(kind));
  if (!(distance >= least && distance <= 2 * radius))
    wrong("distance of neighbours", distance,
          fmt::format("at least {} m and at most the diameter", least));
  const UnitCell unit = unit_cell(kind);
  Packing packing;
  packing.dimension = 3;
  std::array<std::vector<double>, 3> positions;
  for (std::size_t c = 0; c < cells[2]; ++c)
    for (std::size_t b = 0; b < cells[1]; ++b)
      for (std::size_t a = 0; a < cells[0]; ++a)
        for (const Vec<3>& position : unit.positions)
          for (std::size_t k = 0; k < 3; ++k) {
            // A quarter of a distance from the cell's faces, so that rounding cannot carry a sphere
            // across.
            const double at = static_cast<double>(std::array{a, b, c}[k]) + position[k] + 0.25;
            positions[k].push_back(at * unit.edges[k] * distance);
          }
  packing.radius.assign(positions[0].size(), radius);
  for (std::size_t k = 0; k < 3; ++k) {
    packing.cell[4 * k] = static_cast<double>(cells[k]) * unit.edges[k] * distance;
    packing.position.insert(packing.position.end(), positions[k].begin(), positions[k].end());
  }
  return packing;
}

double pressure_share(GeneratorKind kind) {
  const UnitCell unit = unit_cell(kind);
  const double volume = unit.edges[0] * unit.edges[1] * unit.edges[2];
  return unit.neighbours * static_cast<double>(unit.positions.size()) / (6 * volume);
}

double most_lattice_overlap(GeneratorKind kind) {
  // Second neighbours of bcc lie along the cube's edge.
  return kind == GeneratorKind::bcc ? 1 - std::numbers::sqrt3 / 2 : most_overlap;
}

}  // namespace grainlaw::core
