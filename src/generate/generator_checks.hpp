// What no packing can be made of.
#pragma once

#include "contact/law.hpp"
#include "generate/generator.hpp"

#include <string>

namespace grainlaw::core {

// The most that neighbours may overlap, of their distance at first touch: contact laws of round grains
// mean small overlaps.
inline constexpr double most_overlap = 0.2;
// The least that a pressure may make it: below, neighbours touch or not by rounding.
inline constexpr double least_overlap = 1e-10;

// Throws Error (BAD_PACKING) "generator: name = value, expected ...".
[[noreturn]] void wrong(const char* name, double value, const std::string& expected);

// Pressure or void ratio and friction, of particles of about this radius. Throws as wrong().
template <int D>
void check_target(const GeneratorOptions& options, const ContactLaw& law, double radius);

}  // namespace grainlaw::core
