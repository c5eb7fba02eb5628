// A start configuration for compaction: discs of given sizes, loose, at random places in a square
// cell.
#pragma once

#include "packing/packing.hpp"

#include <cstddef>
#include <cstdint>

namespace grainlaw {

struct GeneratorOptions {
  std::size_t count = 400;
  double radius_min = 3e-3;  // [m]
  double radius_max = 7e-3;  // [m]
  std::uint64_t seed = 1;
  double pressure = 1e5;   // of the consolidated packing [Pa]; unused when void_ratio > 0
  double void_ratio = 0;   // target instead of the pressure [-]; 0: the pressure is the target
  double friction = 0;     // tan(phi) during consolidation [-]
  double thickness = 0.1;  // [m]
  double density = 2650;   // of the grains [kg/m3]
};

// Radii are the quantiles (i + 1/2) / count of the uniform distribution, so that every seed has the
// same grading; order and places depend on the seed, bit for bit the same on every platform. No two
// discs touch; discs cover 40 % of the cell. Throws Error (BAD_PACKING) for options out of range:
// count < 1, 0 < radius_min <= radius_max, thickness > 0, density > 0.
Packing scatter(const GeneratorOptions& options);

}  // namespace grainlaw
