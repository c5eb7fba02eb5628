// What the loops of BlockLU over a factorisation share: how they see it, and blocks as registers.
#pragma once

#include "equilibrium/block_matrix.hpp"
#include "equilibrium/quad.hpp"

#include <cstddef>
#include <cstdint>

namespace grainlaw {

struct BlockLU::Factor {
  std::size_t nodes;
  const std::size_t* begin;
  const std::size_t* diagonal;
  const char* paired;
  const std::int32_t* rows;
  const std::int32_t* node;
  const std::size_t* source_begin;
  const Source* sources;
  std::int32_t* where;
  const double* added;  // may be null
  const double* matrix;
  double* values;
};

namespace block_lu {

using namespace quad;
using Factor = BlockLU::Factor;

template <int b>
struct Block {
  Lanes column[b];
};

template <int b>
GRAINLAW_INLINE Block<b> load_block(const double* from) {
  Block<b> block;
#pragma GCC unroll 3
  for (std::size_t c = 0; c < b; ++c) block.column[c] = load(from + c * width);
  return block;
}

template <int b>
GRAINLAW_INLINE void store_block(double* to, const Block<b>& block) {
#pragma GCC unroll 3
  for (std::size_t c = 0; c < b; ++c) store(to + c * width, block.column[c]);
}

}  // namespace block_lu
}  // namespace grainlaw
