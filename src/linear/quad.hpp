// Quads as the loops over them see them: one vector register each.
#pragma once

#include "base/simd.hpp"
#include "linear/block_matrix.hpp"

#include <cstddef>

namespace grainlaw::quad {

using simd::store;
using Lanes = simd::Lanes<4>;
constexpr std::size_t width = 4;
static_assert(sizeof(Quad) == sizeof(Lanes));
GRAINLAW_INLINE Lanes load(const double* from) { return simd::load<4>(from); }

}  // namespace grainlaw::quad
