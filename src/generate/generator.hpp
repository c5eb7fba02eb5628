// How a packing is to be made, and the start configuration of a compaction: particles of given sizes,
// loose, at random places in a square or cubic cell.
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
  square,  // of discs
  hexagonal,
  sc,  // of spheres
  bcc,
  fcc,
  hcp
};

struct GeneratorOptions {
  GeneratorKind kind = GeneratorKind::compaction;
  double pressure = 1e5;   // of the packing at F = I [Pa]; unused when another target is given
  double thickness = 0.1;  // [m]
  double density = 2650;   // of the grains [kg/m3]

  // Random packings.
  std::size_t count = 400;
  double radius_min = 3e-3;  // [m]
  double radius_max = 7e-3;  // [m]
  std::uint64_t seed = 1;
  double void_ratio = 0;        // target instead of the pressure [-]; 0: the pressure is the target
  double friction = 0;          // tan(phi) during consolidation [-]
  bool finds_friction = false;  // that leads to the pressure and the void ratio together
  // Wanted fabric anisotropy, largest / smallest eigenvalue - 1 (Liu et al. eq. 38), and its major
  // direction: of discs the angle against axis 1 [rad], of spheres a vector; below 0: as it comes.
  double anisotropy = -1;
  double anisotropy_direction = 0;
  std::array<double, 3> anisotropy_axis{0, 0, 1};
  // Event-driven growth: of the mean radius, over the mean thermal speed [-]; and the volume
  // fraction where it ends [-], 0: when the discs jam.
  double growth_rate = 0.01;
  double growth_end = 0;

  // Regular packings: discs in a row and rows of the periodic cell, all of radius_max.
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::array<std::size_t, 3> cells{1, 1, 1};  // of a lattice of spheres along each axis
  std::optional<double> overlap;  // of neighbours, instead of the pressure; 0: they touch [m]
  // Radii are drawn from (1 +- this) radius_max by the seed: a perfect lattice stays one under any
  // F, since the affine image is in equilibrium whether or not it is stable [-].
  double radius_spread = 0;

  [[nodiscard]] bool regular() const {
    return kind != GeneratorKind::compaction && kind != GeneratorKind::lubachevsky_stillinger;
  }
};

// In [0, 1), from the engine's bits: they are fixed by the standard; what its distributions make of
// them is not.
inline double unit_double(std::mt19937_64& engine) {
  return static_cast<double>(engine() >> 11) * 0x1p-53;
}

// The quantiles (i + 1/2) / count of the uniform distribution of radii in random order, so that
// every seed has the same grading [m].
std::vector<double> graded_radii(const GeneratorOptions& options, std::mt19937_64& engine);

// Particles of graded radii; order and places depend on the seed, bit for bit the same on every
// platform. No two touch; discs cover 40 % of the cell, spheres fill 25 %. Throws Error (BAD_PACKING)
// for options out of range: count < 1, 0 < radius_min <= radius_max, thickness > 0, density > 0.
template <int D = 2>
Packing scatter(const GeneratorOptions& options);

}  // namespace grainlaw::core
