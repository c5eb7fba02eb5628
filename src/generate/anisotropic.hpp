// Consolidation to a wanted fabric anisotropy.
#pragma once

#include "generate/generator.hpp"
#include "generate/stress_control.hpp"

namespace grainlaw::core {

// Finds the deviatoric stress at which the fabric of the contact normals has the anisotropy
// options.anisotropy. A = largest / smallest eigenvalue of the fabric - 1 (Liu, Bosco & Suiker
// 2019, eq. 38), major along the options' direction. In space the fabric is axisymmetric about it.
// A secant search follows a path of equilibria at the target's mean pressure or volume. At
// isotropic stress A would be a few hundredths, by chance and history. The deviatoric stress
// remains in the packing. One contact changes A by some 2 / contacts, so that packings of a hundred
// particles or more meet A to 0.005. Throws Error (NOT_CONVERGED) with the anisotropies that were
// found.
template <int D>
void consolidate_anisotropically(StressControl<D>& control, StressTarget<D> target,
                                 const GeneratorOptions& options);

}  // namespace grainlaw::core
