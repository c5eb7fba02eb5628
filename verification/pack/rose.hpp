// Rose diagram of contact normals.
#pragma once

#include "pack/written.hpp"

#include <string>
#include <vector>

namespace verification {

struct Rose {
  std::vector<double> density;  // per sector of 2 pi, over that of an isotropic packing [-]
  double anisotropy = 0;        // largest / smallest eigenvalue of the fabric - 1 [-]
  double direction = 0;         // of the major direction from x [rad]
};

// Counts every contact with both normals (Liu, Bosco & Suiker 2019, eq. 39); copies in a frame
// count once.
Rose contact_rose(const WrittenPacking& packing, int sectors = 36);

// Gnuplot commands for the current plot of a multiplot, with the second-order density of this
// fabric.
std::string plot_rose(const Rose& rose);

}  // namespace verification
