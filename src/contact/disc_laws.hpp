// Loops over the contacts of discs, one set for each law.
#pragma once

#include "contact/disc_loops.hpp"
#include "contact/disc_stiffness_loop.hpp"

namespace grainlaw::core::disc_loops {

struct Law {
  LoopResult (*near)(const Loop&);  // rotations of branches within the short series
  LoopResult (*far)(const Loop&);
  LoopResult (*advancing)(const Loop&);
  ContactTotals (*stiffnesses)(const Loop&);
};

extern const Law smooth, locked, rotating, rolling, bonded_locked, bonded;
extern const Law hertz_smooth, hertz_locked, hertz, hertz_rolling;

#define GRAINLAW_DISC_LAW(name, ...)                                                \
  constexpr Features name##_law{__VA_ARGS__};                                       \
  GRAINLAW_LOOP(LoopResult, name##_near, contact_loop, name##_law, false, false)    \
  GRAINLAW_LOOP(LoopResult, name##_far, contact_loop, name##_law, true, false)      \
  GRAINLAW_LOOP(LoopResult, name##_advancing, contact_loop, name##_law, true, true) \
  GRAINLAW_LOOP(ContactTotals, name##_stiffnesses, stiffness_loop, name##_law)      \
  constexpr Law name##_loops{name##_near, name##_far, name##_advancing, name##_stiffnesses};
// Laws without tangential springs have one loop for all.
#define GRAINLAW_SMOOTH_DISC_LAW(name, ...)                                      \
  constexpr Features name##_law{__VA_ARGS__};                                    \
  GRAINLAW_LOOP(LoopResult, name##_near, contact_loop, name##_law, false, false) \
  GRAINLAW_LOOP(ContactTotals, name##_stiffnesses, stiffness_loop, name##_law)   \
  constexpr Law name##_loops{name##_near, name##_near, name##_near, name##_stiffnesses};

}  // namespace grainlaw::core::disc_loops
