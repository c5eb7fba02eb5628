// Rose diagram: how many contact normals point in which direction.
#pragma once

#include "app/svg.hpp"
#include "pack/written.hpp"

#include <vector>

namespace verification {

struct Rose {
  std::vector<double>
      density;            // per sector of the full turn, over that of an isotropic packing [-]
  double anisotropy = 0;  // largest / smallest eigenvalue of the fabric - 1 [-]
  double direction = 0;   // of the larger eigenvalue against x [rad]
};

// Every contact counts with its normal and the opposite one (Liu, Bosco & Suiker 2019, eq. 39);
// copies in a frame count once.
Rose contact_rose(const WrittenPacking& packing, int sectors = 36);

// Draws it within a circle [pixels]: the density 1 dashed, and the second-order density of the same fabric.
void draw_rose(Svg& svg, const Rose& rose, double x, double y, double radius);

}  // namespace verification
