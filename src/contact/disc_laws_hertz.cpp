// Loops of discs with Hertz-Mindlin contacts.
#include "contact/disc_laws.hpp"

namespace grainlaw::core::disc_loops {

namespace {

//                                                         hertz  bonds  moments
GRAINLAW_SMOOTH_DISC_LAW(hertz_smooth, Kinematics::frictionless, true, false, false)
GRAINLAW_DISC_LAW(hertz_locked, Kinematics::locked, true, false, false)
GRAINLAW_DISC_LAW(hertz, Kinematics::rotating, true, false, false)
GRAINLAW_DISC_LAW(hertz_rolling, Kinematics::rotating, true, false, true)

}  // namespace

const Law hertz_smooth = hertz_smooth_loops, hertz_locked = hertz_locked_loops, hertz = hertz_loops,
          hertz_rolling = hertz_rolling_loops;

}  // namespace grainlaw::core::disc_loops
