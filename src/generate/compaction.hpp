// Generation of packings from options.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Random packings: particles are scattered, or grown until they jam, then compressed. Stiff
// packings, kn / (p t) above 1e3 (t of spheres one diameter), are compressed to where it is 1e3 and
// unloaded through equilibria. A wanted anisotropy comes from anisotropic consolidation, whose
// deviatoric stress stays at F = I.
// Regular packings: lattices of equal particles at the distance that gives the pressure.
// The contact law is the material's with options.friction as its friction (0: the densest random
// packing). Friction that is found leads to the void ratio at the pressure, to 1e-3 of 1 + void
// ratio. The result is in equilibrium to 1e-9 of the mean contact force and has its contact
// forces. To 1e-6, all normal stresses are -pressure, or the void ratio is the target and they are
// equal. One machine gives one result per options, to the bit. Throws Error: NOT_CONVERGED;
// BAD_PACKING for options out of range, for particles that bear no load at the target void ratio,
// and for a pressure beyond the largest overlap.
template <int D = 2>
Packing consolidate(const GeneratorOptions& options, const ContactLaw& law);

}  // namespace grainlaw::core
