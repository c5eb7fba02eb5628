// Damped relaxation in pseudo-time towards equilibrium: unit steps, masses that follow the
// contacts.
#pragma once

#include "equilibrium/increment.hpp"

#include <span>
#include <vector>

namespace grainlaw {

enum class History { committed, advancing };

// Memory of the relaxations, reused from call to call.
struct RelaxationMemory {
  std::vector<double> velocity, previous, mass, gain, correction;
};

struct PublishedOptions;

// Viscous relaxation to residual_norm() < tolerance; the damping follows the lowest active
// frequency and adapts its floor to flutter. Returns whether it got there within max_steps.
bool relax(Increment& increment, double tolerance, long max_steps, History history,
           RelaxationMemory& memory);

// The papers' dynamic relaxation: physical masses, local damping -alpha |f| sign(v) (Liu, Bosco &
// Suiker 2017 eq. 10), explicit steps, history advanced at every step. Ends at the residual
// tolerance or, when energy_tolerance > 0, at Ek/Ep <= tolE (eq. 11) once Ek has fallen. `frozen`
// marks nodes that do not move (may be empty).
bool relax_published(Increment& increment, double tolerance, const PublishedOptions& options,
                     std::span<const char> frozen, RelaxationMemory& memory);

}  // namespace grainlaw
