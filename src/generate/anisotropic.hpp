// Consolidation to a wanted fabric anisotropy.
#pragma once

#include "generate/generator.hpp"
#include "generate/stress_control.hpp"

namespace grainlaw::core {

// Finds the deviatoric stress under which the contact normals have the wanted options.anisotropy
// A = largest / smallest eigenvalue of the fabric - 1 (Liu, Bosco & Suiker 2019, eq. 38), major along
// the options' direction, of spheres alike in all directions across it, by a secant search along a
// path of equilibria; the mean pressure, or the volume, of the target is kept. Fabric follows stress: at
// isotropic stress only what chance and history left of it stays, a few hundredths. The deviatoric stress
// remains in the packing. Contacts come and go one by one, each of which changes A by some 2 / contacts:
// A is met to 0.005, where the packing is large enough (a hundred particles or more). Throws Error
// (NOT_CONVERGED) with the anisotropies that were found.
template <int D>
void consolidate_anisotropically(StressControl<D>& control, StressTarget<D> target,
                                 const GeneratorOptions& options);

}  // namespace grainlaw::core
