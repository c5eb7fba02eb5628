// Regular packings of equal discs: rows of a square or of a hexagonal lattice in a periodic cell.
#pragma once

#include "packing/packing.hpp"

#include <cstddef>

namespace grainlaw::core {

// Discs of `radius` in `rows` rows of `columns`, neighbours at `distance` [m]. Every disc touches 4
// (square) or 6 (hexagonal) others in a rectangular cell. Every second row of a hexagonal packing
// is shifted by half a distance, so that `rows` must be even. A frame cut from it has (columns + 1)
// x (rows + 1) discs, opposite sides included (Liu, Bosco & Suiker 2017, section 4.1: 25 discs from
// 4 x 4). Throws Error (BAD_PACKING).
Packing square_lattice(std::size_t columns, std::size_t rows, double radius, double distance);
Packing hexagonal_lattice(std::size_t columns, std::size_t rows, double radius, double distance);

}  // namespace grainlaw::core
