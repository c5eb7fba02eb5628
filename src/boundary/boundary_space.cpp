#include "boundary/boundary_space.hpp"

#include "packing/geometry.hpp"

#include <cmath>
#include <numeric>

namespace grainlaw::core {

template <int D>
BoundarySpace<D> make_cell_space(const Packing& packing, const BoundaryOptions& options) {
  BoundarySpace<D> space;
  space.options = options;
  space.reference_volume =
      std::abs(determinant<D>(packing.cell.data())) * (D == 2 ? packing.thickness : 1);
  const auto n = packing.size();
  space.nodes = space.sources = n;
  space.node.resize(n);
  std::iota(space.node.begin(), space.node.end(), 0);
  space.source = space.node;
  for (const double r : packing.radius) {
    space.solid_volume += particle_volume<D>(r, packing.thickness);
  }
  return space;
}

template <int D>
void BoundarySpace<D>::drop(std::vector<NeighbourPair<D>>& pairs) const {
  if (rows.empty()) return;
  std::erase_if(pairs, [this](const NeighbourPair<D>& pair) {
    return (rows[static_cast<std::size_t>(pair.i)] & rows[static_cast<std::size_t>(pair.j)]) != 0;
  });
}

template struct BoundarySpace<2>;
template struct BoundarySpace<3>;
template BoundarySpace<2> make_cell_space<2>(const Packing&, const BoundaryOptions&);
template BoundarySpace<3> make_cell_space<3>(const Packing&, const BoundaryOptions&);

}  // namespace grainlaw::core
