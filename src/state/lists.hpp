// Particles and contacts of an equilibrium, as hosts receive them.
#pragma once

#include "material/material.hpp"

#include <grainlaw/grainlaw.h>

#include <vector>

namespace grainlaw::core {

// Lists particles in the order of the packing.
template <int D>
[[nodiscard]] std::vector<grainlaw_particle> list_particles(const Material<D>& material,
                                                            const Configuration<D>& at);

// Lists contacts ordered by i, j and shift.
template <int D>
[[nodiscard]] std::vector<grainlaw_contact> list_contacts(const Material<D>& material,
                                                          const Configuration<D>& at);

}  // namespace grainlaw::core
