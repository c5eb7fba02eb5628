// The papers' dynamic relaxation: physical masses, local damping -alpha |f| sign(v) (Liu, Bosco &
// Suiker 2017 eq. 10), explicit steps, history advanced at every step.
#pragma once

#include "increment/increment.hpp"
#include "reference/servo_memory.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

struct PublishedOptions {
  double damping = 0.7;          // alpha = beta of Liu et al. (2017) eq. 10 [-]
  double time_step_ratio = 0.3;  // of the critical step min sqrt(m / kn) [-]
  double energy_tolerance = 0;   // tolE of eq. 11; 0: use the residual tolerance alone [-]
  long max_steps = 400000;
};

// Memory of these methods, reused from call to call; without them it stays empty.
struct ReferenceMemory {
  std::vector<double> velocity, mass, correction;
  ServoMemory servo;
};

// Ends at the residual tolerance or, when energy_tolerance > 0, at Ek/Ep <= tolE (eq. 11) once Ek has
// fallen. `frozen` has the bits of Fixed of nodes that do not move (may be empty: all do, and F where
// it is found).
template <int D>
bool relax_published(Increment<D>& increment, double tolerance, const PublishedOptions& options,
                     std::span<const unsigned char> frozen, ReferenceMemory& memory);

}  // namespace grainlaw::core
