// One scene of `grainlaw point` from start to end, with its table and pictures.
#pragma once

#include "point/scene.hpp"

#include <filesystem>
#include <string>

namespace verification {

// How far a path went and what it cost.
struct PointEnd {
  int particles = 0;  // all copies of a frame
  int steps = 0;
  int steps_wanted = 0;
  Tensor deformation = Tensor::Identity();  // F of the last step [-]
  Effort effort;                            // sum over the steps
  double cpu = 0;                           // of the thread, pictures left out [s]
  grainlaw_status status = GRAINLAW_OK;     // that ended it
  std::string text = "done";
};

// Writes stem.csv, .svg, .png and what the scene asks for beside them. A path that ends early is
// told in the result; what was reached stays written. Throws InputError, and ComputationError when
// there is no equilibrium at the start.
PointEnd run_point(const PointScene& scene, const std::filesystem::path& stem);

}  // namespace verification
