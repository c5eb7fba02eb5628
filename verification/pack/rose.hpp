// Rose diagram: how many contact normals point in which direction.
#pragma once

#include "pack/written.hpp"

#include <string>
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

// Gnuplot commands that draw it into the current plot of a multiplot, with the second-order density
// that has the same fabric.
std::string plot_rose(const Rose& rose);

}  // namespace verification
