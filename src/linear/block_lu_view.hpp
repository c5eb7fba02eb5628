// A factorisation as the loops over its fronts see it.
#pragma once

#include "linear/block_lu.hpp"
#include "linear/dense_panels.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace grainlaw {

struct BlockLU::View {
  std::span<const Front> fronts;
  const std::int32_t* rows;
  const std::int32_t* within;
  const std::int32_t* node;
  const Source* sources;
  double* values;
  dense::Pivot* pivots;
  Run* runs;
};

}  // namespace grainlaw
