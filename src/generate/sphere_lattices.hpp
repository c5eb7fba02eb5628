// Regular packings of equal spheres in a rectangular periodic cell.
#pragma once

#include "generate/generator.hpp"
#include "packing/packing.hpp"

#include <array>
#include <cstddef>

namespace grainlaw::core {

// A lattice with so many cells along each axis and neighbours at `distance` d [m]:
//   sc   simple cubic, d wide, 1 sphere in a cell, 6 neighbours;
//   bcc  body-centred cubic, 2 / sqrt(3) d wide, 2 spheres, 8 neighbours;
//   fcc  face-centred cubic, sqrt(2) d wide, 4 spheres, 12 neighbours;
//   hcp  hexagonal close packing, d x sqrt(3) d x sqrt(8/3) d, 4 spheres, 12 neighbours.
// Throws Error (BAD_PACKING).
Packing sphere_lattice(GeneratorKind kind, const std::array<std::size_t, 3>& cells, double radius,
                       double distance);

// Isotropic pressure of a lattice times d^2 over the force between neighbours, from p V = 1/3 sum
// fn d [-].
double pressure_share(GeneratorKind kind);

// Largest overlap of neighbours without contacts between others, over the diameter [-].
double most_lattice_overlap(GeneratorKind kind);

}  // namespace grainlaw::core
