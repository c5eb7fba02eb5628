// Making a packing: isotropic compaction of loose discs to a pressure or to a void ratio.
#pragma once

#include "contact/law.hpp"
#include "packing/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw {

// Scatter discs and compress them, as the periodic servo of the reference packings does (Guo & Zhao
// 2014; YADE's PeriTriaxController, slow), quasi-statically: both stretches shrink in small steps,
// the particles relax, until the packing bears load; then each stretch follows its own stress. The
// cell stays rectangular and the shear stress free. The contact law is that of the material with
// options.friction in place of its friction (0: the densest random packing).
// The result is in equilibrium to 1e-9 of the mean contact force, and either both normal stresses
// are -pressure, or the void ratio is the target and both normal stresses are equal, to 1e-6. It
// carries its contact forces. Same options, same machine: same bits. Throws Error: BAD_PACKING for
// options out of range, or when the discs bear no load at the target void ratio; NOT_CONVERGED.
Packing consolidate(const GeneratorOptions& options, const ContactLaw& law);

}  // namespace grainlaw
