// The paths of small increments in three dimensions.
#pragma once

#include "evidence/studies/reach/paths.hpp"

namespace verification::reach {

// Spheres of one to two radii, compacted without friction to 100 kPa with kn / (p d) = `stiffness` of two of
// mean radius, then with this friction tan(phi). Throws ComputationError.
Material make_spheres(int count, long seed, double tolerance, double stiffness, double friction);

// By the kind of the path: "drained", triaxial at constant lateral stress; "isochoric", triaxial at constant
// volume; "shear", F13 alone.
void lead_spheres(Path& path, const Material& material, const SmallIncrements& limits,
                  const Observer& observe);

}  // namespace verification::reach
