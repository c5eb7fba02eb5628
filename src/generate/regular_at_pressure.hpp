// Regular packings with the overlap that a pressure gives, or a given one.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Discs: square or hexagonal; spheres: sc, bcc, fcc, hcp. Throws Error (BAD_PACKING).
template <int D>
Packing make_regular(const GeneratorOptions& options, const ContactLaw& law);

}  // namespace grainlaw::core
