// What block matrices and vectors over their nodes are made of: whole registers of 4 or 8 doubles.
#pragma once

#include "base/simd.hpp"

#include <cstddef>
#include <type_traits>

namespace grainlaw::core {

// Unknowns of a node, by the width of columns: there is no code for others.
enum SizeOfFour : int { blocks_of_2 = 2, blocks_of_3 = 3 };
enum SizeOfEight : int { blocks_of_6 = 6 };
template <std::size_t width>
using BlockSize = std::conditional_t<width == 4, SizeOfFour, SizeOfEight>;

// Rows of a block of b x b, filled up to whole registers.
constexpr std::size_t rows_of(std::size_t b) { return b <= 4 ? 4 : 8; }

// A column of a block; or a vector's entries at a node. Rows beyond the block's are zero.
template <std::size_t width>
struct alignas(width * sizeof(double)) BlockColumn {
  double lane[width] = {};
};

// One entry of as many vectors together, one in every lane: right-hand sides, or their solutions.
template <std::size_t width>
struct alignas(width * sizeof(double)) Together {
  double lane[width] = {};
};

}  // namespace grainlaw::core
