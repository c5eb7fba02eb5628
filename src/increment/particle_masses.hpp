// Masses of particles, for fluctuations with inertia.
#pragma once

#include "boundary/boundary_space.hpp"
#include "contact/records.hpp"
#include "packing/packing.hpp"

#include <vector>

namespace grainlaw::core {

// Masses of the nodes; rotations R theta have I / R^2 [kg]. Copies of a particle share its mass.
template <int D>
void find_particle_masses(const Packing& packing, const BoundarySpace<D>& space,
                          std::vector<MassRecord<D>>& masses);

}  // namespace grainlaw::core
