// Making a packing as a generator's options ask.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Random packings: particles are scattered, or grown until they jam, and compressed; stiff ones, kn / (p t)
// above 1e3 (t of spheres a diameter), are compressed to where it is 1e3 and expanded again in equilibrium. A wanted anisotropy
// comes by anisotropic consolidation: the deviatoric stress that makes it stays at F = I. Regular
// packings: lattices of equal particles at the distance that gives the pressure. The contact law is that of the material with
// options.friction in place of its friction (0: the densest random packing); friction that is found leads to
// the void ratio at the pressure, to 1e-3 of 1 + void ratio.
// The result is in equilibrium to 1e-9 of the mean contact force, and either all normal stresses
// are -pressure, or the void ratio is the target and all normal stresses are equal, to 1e-6. It
// carries its contact forces. Same options, same machine: same bits. Throws Error: BAD_PACKING for
// options out of range, when the particles bear no load at the target void ratio, and for a pressure that
// would press particles into one another; NOT_CONVERGED.
template <int D = 2>
Packing consolidate(const GeneratorOptions& options, const ContactLaw& law);

}  // namespace grainlaw::core
