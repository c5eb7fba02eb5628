// The laws beyond linear springs with friction: Hertz-Mindlin, bonds, moments. Called by
// frictional.hpp.
#pragma once

#include "contact/frictional.hpp"

#include <span>

namespace grainlaw {

void evaluate_composite(std::span<const ParticleRecord> particles, const ContactLaw& law,
                        ContactList& list, std::span<ForceRecord> nodes);
double advance_composite(std::span<const ParticleRecord> particles, const ContactLaw& law,
                         ContactList& list, std::span<ForceRecord> nodes);
ContactTotals sum_composite_stiffnesses(std::span<const ParticleRecord> particles,
                                        const ContactLaw& law, ContactList& list,
                                        std::span<ForceRecord> nodes);

}  // namespace grainlaw
