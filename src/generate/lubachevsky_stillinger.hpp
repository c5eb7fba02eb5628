// Dense random packings by event-driven growth: hard discs or spheres fly, collide and grow until
// they jam.
#pragma once

#include "generate/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Lubachevsky & Stillinger (1990), collision-driven. Small particles start at random positions with
// random velocities, and radii grow in proportion at a constant rate. Collisions are elastic with
// the velocity of the growing surfaces added; velocities are rescaled to one temperature. It ends
// at options.growth_end, or when the reduced pressure p V / (N k T) shows gaps of some 1e-4 of a
// diameter. Radii are those of the options in a periodic square or cubic cell, without contacts.
// One machine gives one result per options, to the bit. Throws Error (BAD_PACKING) for options out
// of range, and for a growth_end beyond jamming.
template <int D = 2>
Packing grow(const GeneratorOptions& options);

}  // namespace grainlaw::core
