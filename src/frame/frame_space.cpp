#include "frame/frame_space.hpp"

#include "base/capacity.hpp"
#include "base/error.hpp"
#include "frame/frame.hpp"
#include "frame/side_rules.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Volume of the particles, copies counted once.
void count_sources(const Packing& packing, BoundarySpace<2>& space) {
  space.source = packing.frame->source;
  space.sources =
      1 + static_cast<std::size_t>(*std::max_element(space.source.begin(), space.source.end()));
  space.copies.assign(space.sources, 0);
  for (std::size_t p = 0; p < packing.size(); ++p) {
    if (space.copies[static_cast<std::size_t>(space.source[p])]++ > 0) continue;
    space.solid_volume += particle_volume<2>(packing.radius[p], packing.thickness);
  }
}

}  // namespace

BoundarySpace<2> make_boundary_space(const Packing& packing, const BoundaryOptions& options) {
  if (options.type == BoundaryType::periodic_cell) return make_cell_space<2>(packing, options);
  if (!packing.frame) {
    throw Error(GRAINLAW_BAD_PACKING, "boundary: a frame condition needs a frame packing");
  }
  BoundarySpace<2> space;
  space.options = options;
  space.identity = false;
  const auto& frame = *packing.frame;
  const bool parallelogram = frame.copies[0] && frame.copies[1];
  space.reference_volume =
      (parallelogram ? std::abs(determinant<2>(packing.cell.data())) : polygon_area(packing)) *
      packing.thickness;
  count_sources(packing, space);
  for (std::size_t k = 0; k < 4; ++k) {
    if (options.type != BoundaryType::mixed || !options.stress[k]) continue;
    space.finds_deformation = space.found[k] = true;
    space.stress[k] = *options.stress[k];
  }
  const Sides sides = sides_of(options);
  space_of_sides(packing, sides, space);
  if (options.type == BoundaryType::mixed) {
    // Sides that do not share their fluctuations are not copies, even if cut as copies.
    space.source = space.node;
    space.sources = space.nodes;
    space.copies.clear();
  }
  return space;
}

void weigh_copies(const BoundarySpace<2>& space, const Packing& packing,
                  std::span<const NeighbourPair<2>> pairs, std::vector<double>& weights) {
  resize_with_capacity(weights, pairs.size());
  std::fill(weights.begin(), weights.end(), 1.0);
  if (space.options.weight == ContactWeight::one) return;
  // Sides of a mixed boundary that do not share their fluctuations are not copies.
  const bool mixed = space.options.type == BoundaryType::mixed;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    weights[c] = 1.0 / contact_copies(*packing.frame, pairs[c].i, pairs[c].j,
                                      !mixed || space.copied[0], !mixed || space.copied[1]);
  }
}

}  // namespace grainlaw::core
