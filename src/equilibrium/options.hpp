// How equilibrium is sought.
#pragma once

#include "reference/local_damping.hpp"

namespace grainlaw::core {

enum class Start { committed, trial };
// chain: friction by return mapping, relaxation then Newton (the default).
// advancing: viscous relaxation that advances the friction history at every step.
// published: local damping, physical masses, history advanced at every step (the papers' method).
enum class Method { chain, advancing, published };

// What an F is at which no contact carries: stress_free makes it an equilibrium with P = 0.
enum class ContactsLost { error, stress_free };

// Fluctuations that meet a drag (increment/drag.hpp): each increment takes a time.
struct Viscosity {
  double time = 0;  // of an increment, in relaxation times of a contact [-]; 0: no end, no drag
  double inertia =
      1;  // share of masses in the drag: how much of the last move is expected again [-]
  double increment = 0;  // host time of an increment that takes `time`; 0: all do, however long
  long steps = 1;        // parts of an increment [-]
};

struct SolverOptions {
  double tolerance = 1e-9;  // largest particle residual / mean contact normal force [-]
  // Residual at which an increment may end that does not reach `tolerance` soon: its friction
  // flutters, and more effort seldom ends that [-]; 0: none.
  double loose_tolerance = 0;
  Start start = Start::committed;
  Method method = Method::chain;
  // Residuals are relative to no less than this [N]; 0: relative_floor of the mean force at F = I.
  double force_floor = 0;
  double increment_limit = 1;  // Pi above which an increment is split [-]
  ContactsLost contacts_lost = ContactsLost::error;
  Viscosity viscosity;
  PublishedOptions published;
};

}  // namespace grainlaw::core
