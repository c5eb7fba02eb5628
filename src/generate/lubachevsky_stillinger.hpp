// Dense random packings by event-driven growth: hard discs or spheres fly, collide and grow until they jam.
#pragma once

#include "generate/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Lubachevsky & Stillinger (1990), the algorithm of the collision-driven codes: particles start small at
// random places with random velocities, all radii grow in proportion at a constant rate, collisions
// are elastic and give what the growing surfaces need, and the velocities are scaled back to the
// same temperature. It ends at options.growth_end, or when the reduced pressure p V / (N k T) shows
// that the free gaps are some 1e-4 of a diameter. The radii come out as options give them, in a
// periodic square or cubic cell; no two touch. Same options: same bits. Throws Error (BAD_PACKING) for
// options out of range, and when growth_end lies beyond the jamming.
template <int D = 2>
Packing grow(const GeneratorOptions& options);

}  // namespace grainlaw::core
