// Elements of block matrices and of vectors over their nodes: whole registers of 4 or 8 doubles,
// or of as many floats.
#pragma once

#include "base/simd.hpp"

#include <cstddef>
#include <type_traits>

namespace grainlaw::core {

// Number of unknowns of a node, by the width of columns; no other sizes are compiled.
enum SizeOfFour : int { blocks_of_2 = 2, blocks_of_3 = 3 };
enum SizeOfEight : int { blocks_of_6 = 6 };
template <std::size_t width>
using BlockSize = std::conditional_t<width == 4, SizeOfFour, SizeOfEight>;

// Rows of a block of b x b, padded to whole registers.
constexpr std::size_t rows_of(std::size_t b) { return b <= 4 ? 4 : 8; }

// Column of a block, or the entries of a vector at a node. Padding rows are zero.
template <std::size_t width, class Real = double>
struct alignas(width * sizeof(Real)) BlockColumn {
  Real lane[width] = {};
};

// Entry of several vectors, one vector per lane: right-hand sides or solutions.
template <std::size_t width, class Real = double>
struct alignas(width * sizeof(Real)) Together {
  Real lane[width] = {};
};

}  // namespace grainlaw::core
