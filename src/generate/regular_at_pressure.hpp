// Regular packings whose neighbours overlap as much as a pressure asks for, or as told.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"
#include "packing/packing.hpp"

namespace grainlaw::core {

// Of discs: square or hexagonal; of spheres: sc, bcc, fcc, hcp. Throws Error (BAD_PACKING).
template <int D>
Packing make_regular(const GeneratorOptions& options, const ContactLaw& law);

}  // namespace grainlaw::core
