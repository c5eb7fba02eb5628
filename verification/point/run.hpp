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
  // F of the last step, of discs that of plane strain [-].
  TensorOf<3> deformation = TensorOf<3>::Identity();
  Effort effort;                         // sum over the steps
  double cpu = 0;                        // of the thread, pictures left out [s]
  grainlaw_status status = GRAINLAW_OK;  // that ended it
  std::string text = "done";             // or why it is not
};

// Writes stem.csv, .svg, .png and what the scene asks for beside them, and tells what the run took
// and wrote. Of a path that ends early, or is asked to, what was reached stays written. Throws
// InputError, Interrupted, and ComputationError where the scene does not allow for an early end;
// `end` then holds what there is.
void run_point(const PointScene& scene, const std::filesystem::path& stem, PointEnd& end);

}  // namespace verification
