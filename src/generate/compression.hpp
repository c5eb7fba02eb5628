// Isotropic compression of loose particles to a pressure or to a void ratio.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"
#include "increment/configuration.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Compresses like the periodic servo of the reference packings (Guo & Zhao 2014; YADE's
// PeriTriaxController), quasi-statically. All stretches shrink in small steps with relaxations
// until the packing bears load; then each stretch follows its own stress. The cell stays
// rectangular, whatever the shear stresses. Only pressure and void_ratio of the options count. The
// result, relative to the loose packing at F = I, is in equilibrium to 1e-9 of the mean contact
// force. To 1e-6, all normal stresses are -pressure, or the void ratio is the target and they are
// equal. Throws Error: BAD_PACKING when the particles bear no load at the target void ratio;
// NOT_CONVERGED, often for kn / (p t) beyond 1e4, t of spheres one diameter.
template <int D>
Configuration<D> compress(const Packing& loose, const GeneratorOptions& options,
                          const ContactLaw& law);

}  // namespace grainlaw::core
