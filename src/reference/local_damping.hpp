// The published dynamic relaxation: physical masses, local damping -alpha |f| sign(v) (Liu, Bosco &
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
  double energy_tolerance = 0;   // tolE of eq. 11; 0: residual tolerance alone [-]
  long max_steps = 400000;
};

// Workspace of the published methods, reused between calls; empty when they are not used.
struct ReferenceMemory {
  std::vector<double> velocity, mass, correction;
  ServoMemory servo;
};

// Relaxes until the residual tolerance or, with energy_tolerance > 0, until Ek/Ep <= tolE (eq. 11)
// once Ek has fallen. `frozen` has fixed_bit of node components that stay; empty: all nodes move,
// and found components of F too.
template <int D>
bool relax_published(Increment<D>& increment, double tolerance, const PublishedOptions& options,
                     std::span<const unsigned char> frozen, ReferenceMemory& memory);

}  // namespace grainlaw::core
