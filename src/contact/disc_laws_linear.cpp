// Loops of discs with linear springs.
#include "contact/disc_laws.hpp"

namespace grainlaw::core::disc_loops {

namespace {

//                                                    hertz  bonds  moments
GRAINLAW_SMOOTH_DISC_LAW(smooth, Kinematics::frictionless)
GRAINLAW_DISC_LAW(locked, Kinematics::locked)
GRAINLAW_DISC_LAW(rotating, Kinematics::rotating)
GRAINLAW_DISC_LAW(rolling, Kinematics::rotating, false, false, true)
GRAINLAW_DISC_LAW(bonded_locked, Kinematics::locked, false, true, false)
GRAINLAW_DISC_LAW(bonded, Kinematics::rotating, false, true, true)

}  // namespace

const Law smooth = smooth_loops, locked = locked_loops, rotating = rotating_loops,
          rolling = rolling_loops, bonded_locked = bonded_locked_loops, bonded = bonded_loops;

}  // namespace grainlaw::core::disc_loops
