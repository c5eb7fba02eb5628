// Isotropic compression of loose particles to a pressure or to a void ratio.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"
#include "increment/configuration.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// As the periodic servo of the reference packings does (Guo & Zhao 2014; YADE's PeriTriaxController,
// slow), quasi-statically: all stretches shrink in small steps, the particles relax, until the
// packing bears load; then each stretch follows its own stress. The cell stays rectangular and
// shear stresses are what they are. Of the options only pressure and void_ratio count here. The result,
// whose F = I is the loose packing, is in equilibrium to 1e-9 of the mean contact force, and either
// all normal stresses are -pressure, or the void ratio is the target and they are equal, to 1e-6.
// Throws Error: BAD_PACKING when the particles bear no load at the target void ratio; NOT_CONVERGED,
// often where kn / (p t), t of spheres a diameter, is beyond 1e4.
template <int D>
Configuration<D> compress(const Packing& loose, const GeneratorOptions& options,
                          const ContactLaw& law);

}  // namespace grainlaw::core
