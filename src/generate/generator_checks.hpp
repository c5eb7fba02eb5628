// Checks of a generator's options.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"

#include <string>

namespace grainlaw::core {

// Largest overlap of neighbours over their distance at first touch; contact laws of round grains
// assume small overlaps.
inline constexpr double most_overlap = 0.2;
// Least overlap from a pressure over that distance; rounding decides about smaller ones.
inline constexpr double least_overlap = 1e-10;

// Throws Error (BAD_PACKING) "generator: name = value, expected ...".
[[noreturn]] void wrong(const char* name, double value, const std::string& expected);

// Checks pressure or void ratio, and friction, for particles of about this radius. Throws as
// wrong().
template <int D>
void check_target(const GeneratorOptions& options, const ContactLaw& law, double radius);

}  // namespace grainlaw::core
