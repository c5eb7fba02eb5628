#include "increment/particle_masses.hpp"

#include "base/capacity.hpp"
#include "packing/geometry.hpp"

#include <cstddef>

namespace grainlaw::core {

namespace {

// Its filling is 0 too: it multiplies that of other records.
template <int D>
constexpr MassRecord<D> no_mass;
template <>
constexpr MassRecord<2> no_mass<2>{0, 0, 0, 0};
template <>
constexpr MassRecord<3> no_mass<3>{0, 0, 0, 0, 0, 0, {0, 0}};

}  // namespace

template <int D>
void find_particle_masses(const Packing& packing, const BoundarySpace<D>& space,
                          std::vector<MassRecord<D>>& masses) {
  resize_with_capacity(masses, space.nodes);
  for (auto& mass : masses) mass = no_mass<D>;
  for (std::size_t p = 0; p < space.node.size(); ++p) {
    double mass = particle_mass<D>(packing.density, packing.radius[p], packing.thickness);
    if (!space.copies.empty()) mass /= space.copies[static_cast<std::size_t>(space.source[p])];
    auto& of_node = masses[static_cast<std::size_t>(space.node[p])];
    for (std::size_t k = 0; k < Dimension<D>::unknowns; ++k) {
      component(of_node, k) += k < D ? mass : inertia_share<D> * mass;
    }
  }
}

template void find_particle_masses(const Packing&, const BoundarySpace<2>&,
                                   std::vector<MassRecord<2>>&);
template void find_particle_masses(const Packing&, const BoundarySpace<3>&,
                                   std::vector<MassRecord<3>>&);

}  // namespace grainlaw::core
