#include "boundary/boundary_space.hpp"

#include "error.hpp"
#include "packing/frame.hpp"
#include "room.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace grainlaw {

namespace {

double disc_volume(const Packing& packing, std::size_t p) {
  return std::numbers::pi * packing.radius[p] * packing.radius[p] * packing.thickness;
}

}  // namespace

BoundarySpace make_boundary_space(const Packing& packing, const BoundaryOptions& options) {
  BoundarySpace space;
  space.options = options;
  const auto& h = packing.cell;
  space.reference_volume = std::abs(h[0] * h[3] - h[1] * h[2]) * packing.thickness;
  const auto n = packing.size();
  if (options.type == BoundaryType::periodic_cell) {
    space.nodes = n;
    space.node.resize(n);
    std::iota(space.node.begin(), space.node.end(), 0);
    for (std::size_t p = 0; p < n; ++p) space.solid_volume += disc_volume(packing, p);
    return space;
  }
  if (!packing.frame) throw Error(GRAINLAW_BAD_PACKING, "boundary frame-p needs a frame packing");
  const auto& frame = *packing.frame;
  space.identity = false;
  space.node = frame.source;
  space.nodes =
      1 + static_cast<std::size_t>(*std::max_element(frame.source.begin(), frame.source.end()));
  space.fixed.assign(space.nodes, 0);
  space.boundary.assign(space.nodes, 0);
  for (const int q : frame.boundary) {
    space.boundary[static_cast<std::size_t>(space.node[static_cast<std::size_t>(q)])] = 1;
  }
  for (const int q : frame.corner) {
    space.fixed[static_cast<std::size_t>(space.node[static_cast<std::size_t>(q)])] = 1;
  }
  std::vector<char> counted(space.nodes, 0);
  for (std::size_t p = 0; p < n; ++p) {
    auto& seen = counted[static_cast<std::size_t>(space.node[p])];
    if (!seen) space.solid_volume += disc_volume(packing, p);
    seen = 1;
  }
  return space;
}

void BoundarySpace::weigh(const Packing& packing, std::span<const NeighbourPair> pairs,
                          std::vector<double>& weights) const {
  resize_with_room(weights, pairs.size());
  std::fill(weights.begin(), weights.end(), 1.0);
  if (options.weight == ContactWeight::one) return;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    weights[c] = 1.0 / contact_copies(*packing.frame, pairs[c].i, pairs[c].j);
  }
}

}  // namespace grainlaw
