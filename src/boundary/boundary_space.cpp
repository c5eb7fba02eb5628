#include "boundary/boundary_space.hpp"

#include "boundary/frame_space.hpp"
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
    space.nodes = space.sources = n;
    space.node.resize(n);
    std::iota(space.node.begin(), space.node.end(), 0);
    space.source = space.node;
    for (std::size_t p = 0; p < n; ++p) space.solid_volume += disc_volume(packing, p);
    return space;
  }
  if (!packing.frame) {
    throw Error(GRAINLAW_BAD_PACKING, "boundary: a frame condition needs a frame packing");
  }
  const auto& frame = *packing.frame;
  space.identity = false;
  if (!frame.copies[0] || !frame.copies[1]) {
    space.reference_volume = polygon_area(packing) * packing.thickness;
  }
  space.source = frame.source;
  space.sources =
      1 + static_cast<std::size_t>(*std::max_element(frame.source.begin(), frame.source.end()));
  std::vector<char> counted(space.sources, 0);
  for (std::size_t p = 0; p < n; ++p) {
    auto& seen = counted[static_cast<std::size_t>(space.source[p])];
    if (!seen) space.solid_volume += disc_volume(packing, p);
    seen = 1;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (options.type != BoundaryType::mixed || !options.stress[k]) continue;
    space.finds_deformation = space.found[k] = true;
    space.stress[k] = *options.stress[k];
  }
  space_of_sides(packing, sides_of(options), space);
  if (options.type == BoundaryType::mixed) {
    // Sides that do not share their fluctuations are no copies, however they began.
    space.source = space.node;
    space.sources = space.nodes;
  }
  return space;
}

void BoundarySpace::drop(std::vector<NeighbourPair>& pairs) const {
  if (rows.empty()) return;
  std::erase_if(pairs, [this](const NeighbourPair& pair) {
    return (rows[static_cast<std::size_t>(pair.i)] & rows[static_cast<std::size_t>(pair.j)]) != 0;
  });
}

void BoundarySpace::weigh(const Packing& packing, std::span<const NeighbourPair> pairs,
                          std::vector<double>& weights) const {
  resize_with_room(weights, pairs.size());
  std::fill(weights.begin(), weights.end(), 1.0);
  if (options.weight == ContactWeight::one) return;
  // Sides of a mixed boundary that do not share their fluctuations are no copies.
  const bool mixed = options.type == BoundaryType::mixed;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    weights[c] = 1.0 / contact_copies(*packing.frame, pairs[c].i, pairs[c].j, !mixed || copied[0],
                                      !mixed || copied[1]);
  }
}

}  // namespace grainlaw
