// Options of the solver.
#pragma once

#include "reference/local_damping.hpp"

namespace grainlaw::core {

enum class Start { committed, trial };
// direct: friction by return mapping, relaxation, then Newton (the default).
// advancing: viscous relaxation that advances the friction history at every step.
// published: local damping, physical masses, history advanced at every step (the papers' method).
enum class Method { direct, advancing, published };

// Meaning of an F at which no contact transmits force: an error, or an equilibrium with P = 0.
enum class ContactsLost { error, stress_free };

// Drag on the fluctuations, so that rearrangements take time. @formula viscous
struct Viscosity {
  double number = 0;  // strain rate x memory [-]; 0: no drag
  double rate = 0;    // strain rate that `number` is meant at [1 / host time]; 0: time is strain
  long steps = 1;     // parts of an increment [-]
};

struct SolverOptions {
  double tolerance = 1e-9;  // largest particle residual / mean contact normal force [-]
  // Residual at which an increment may end if flutter keeps it from `tolerance`, since more effort
  // rarely helps [-]. 0: never.
  double loose_tolerance = 0;
  Start start = Start::committed;
  Method method = Method::direct;
  // Least force that residuals are relative to [N]. 0: relative_floor of the mean force at F = I.
  double force_floor = 0;
  double increment_limit = 1;  // Pi above which an increment is split [-]
  ContactsLost contacts_lost = ContactsLost::error;
  Viscosity viscosity;
  // The fluctuations have the mass of the particles, and time is the host's. @formula inertia
  bool inertia = false;
  PublishedOptions published;

  // True if a state keeps velocities, and takes the time of its host into account.
  [[nodiscard]] bool keeps_velocities() const { return viscosity.number > 0 || inertia; }
};

}  // namespace grainlaw::core
