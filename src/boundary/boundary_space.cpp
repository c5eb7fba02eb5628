#include "boundary/boundary_space.hpp"

#include "base/room.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace grainlaw {

double particle_volume(const Packing& packing, std::size_t p) {
  return std::numbers::pi * packing.radius[p] * packing.radius[p] * packing.thickness;
}

BoundarySpace make_cell_space(const Packing& packing, const BoundaryOptions& options) {
  BoundarySpace space;
  space.options = options;
  const auto& h = packing.cell;
  space.reference_volume = std::abs(h[0] * h[3] - h[1] * h[2]) * packing.thickness;
  const auto n = packing.size();
  space.nodes = space.sources = n;
  space.node.resize(n);
  std::iota(space.node.begin(), space.node.end(), 0);
  space.source = space.node;
  for (std::size_t p = 0; p < n; ++p) space.solid_volume += particle_volume(packing, p);
  return space;
}

void BoundarySpace::drop(std::vector<NeighbourPair>& pairs) const {
  if (rows.empty()) return;
  std::erase_if(pairs, [this](const NeighbourPair& pair) {
    return (rows[static_cast<std::size_t>(pair.i)] & rows[static_cast<std::size_t>(pair.j)]) != 0;
  });
}

}  // namespace grainlaw
