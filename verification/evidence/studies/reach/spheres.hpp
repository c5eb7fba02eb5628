// The paths of small increments in three dimensions.
#pragma once

#include "evidence/studies/reach/paths.hpp"

namespace verification::reach {

// Spheres whose radii differ by up to a factor of 2, compacted without friction to 100 kPa. `stiffness` is
// kn / (p d) of two of mean radius, `friction` the tan(phi) that they then have. Throws ComputationError.
Material make_spheres(int count, long seed, double tolerance, double stiffness, double friction);

// By the kind of the path: "drained", triaxial at constant lateral stress; "isochoric", triaxial at constant
// volume; "shear", F13 alone.
void lead_spheres(Path& path, const Material& material, const SmallIncrements& limits,
                  const Observer& observe);

}  // namespace verification::reach
