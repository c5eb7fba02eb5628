// What a law makes of the contacts that a packing comes with, or comes without.
#pragma once

#include "equilibrium/configuration.hpp"
#include "material/material.hpp"

namespace grainlaw {

// Bond what touches, or is nearer than the gap, unless the packing names its bonds; take over
// moments. given: contacts of the packing in the order of neighbours.
void add_bonds_and_moments(const Material& material, Configuration& given);

// Mean overlap of the touching discs over their common radius; 1e-3 when none touch [-].
double mean_overlap(const Material& material);

// A mean normal force below which residuals are not relative to it: of laws that bear without any,
// kn times a thousandth of the mean radius; else 0 [N].
double least_force_scale(const Material& material);

}  // namespace grainlaw
