// Options of a generated packing, and the start of a compaction: loose particles of given sizes at
// random positions in a square or cubic cell.
#pragma once

#include "packing/packing.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace grainlaw::core {

enum class GeneratorKind {
  compaction,
  lubachevsky_stillinger,
  square,  // lattices of discs
  hexagonal,
  sc,  // lattices of spheres
  bcc,
  fcc,
  hcp
};

struct GeneratorOptions {
  GeneratorKind kind = GeneratorKind::compaction;
  double pressure = 1e5;   // at F = I [Pa]; unused with another target
  double thickness = 0.1;  // [m]
  double density = 2650;   // density of the grains [kg/m3]

  // Random packings.
  std::size_t count = 400;
  double radius_min = 3e-3;  // [m]
  double radius_max = 7e-3;  // [m]
  std::uint64_t seed = 1;
  double void_ratio = 0;        // target instead of the pressure [-]; 0: none
  double friction = 0;          // tan(phi) during consolidation [-]
  bool finds_friction = false;  // finds the one that leads to the pressure and the void ratio
  // Wanted fabric anisotropy, largest / smallest eigenvalue - 1 (Liu et al. eq. 38); below 0: not
  // controlled. Its major direction is an angle from axis 1 for discs [rad], a vector for spheres.
  double anisotropy = -1;
  double anisotropy_direction = 0;
  std::array<double, 3> anisotropy_axis{0, 0, 1};
  // Event-driven growth: rate of the mean radius over the mean thermal speed [-], and final volume
  // fraction [-]. 0: until the particles jam.
  double growth_rate = 0.01;
  double growth_end = 0;

  // Regular packings: discs per row and rows of the periodic cell, all of radius_max.
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::array<std::size_t, 3> cells{1, 1, 1};  // cells of a lattice of spheres per axis
  std::optional<double> overlap;  // of neighbours instead of the pressure; 0: touching [m]
  // Relative half width of random radii around radius_max [-]. A perfect lattice stays in
  // equilibrium under any F, stable or not, since its affine image is one.
  double radius_spread = 0;

  [[nodiscard]] bool regular() const {
    return kind != GeneratorKind::compaction && kind != GeneratorKind::lubachevsky_stillinger;
  }
};

// Uniform number in [0, 1) from the bits of the engine, which the standard fixes; it does not fix
// its distributions.
inline double unit_double(std::mt19937_64& engine) {
  return static_cast<double>(engine() >> 11) * 0x1p-53;
}

// Radii at the quantiles (i + 1/2) / count of the uniform distribution, in random order: every seed
// has one grading [m].
std::vector<double> graded_radii(const GeneratorOptions& options, std::mt19937_64& engine);

// Scatters particles of graded radii without contacts. Order and positions depend on the seed
// alone, bit for bit on every platform. Discs cover 40 % of the cell, spheres fill 25 %. Throws
// Error (BAD_PACKING) unless count >= 1, 0 < radius_min <= radius_max, thickness > 0, density > 0.
template <int D = 2>
Packing scatter(const GeneratorOptions& options);

}  // namespace grainlaw::core
