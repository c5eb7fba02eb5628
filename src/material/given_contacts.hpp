// What a law makes of the contacts that a packing comes with, or comes without.
#pragma once

#include "increment/configuration.hpp"
#include "material/material.hpp"

namespace grainlaw {

// Bond what touches, or is nearer than the gap, unless the packing names its bonds; take over
// moments. given: contacts of the packing in the order of neighbours.
void add_bonds_and_moments(const Material& material, Configuration& given);

// Mean overlap of the touching discs over their common radius; 1e-3 when none touch by more than
// rounding [-].
double mean_overlap(const Material& material);

// What residuals are relative to where there is no force at F = I to compare with: kn times a
// thousandth of the mean radius [N].
double unloaded_force_scale(const Material& material);

}  // namespace grainlaw
