// Run of one scene of `grainlaw point`, with its table and pictures.
#pragma once

#include "point/scene.hpp"

#include <filesystem>
#include <string>

namespace verification {

// End and cost of a path.
struct PointEnd {
  int particles = 0;  // including copies of a frame
  int steps = 0;
  int steps_wanted = 0;
  // F of the last step; for discs that of plane strain [-].
  TensorOf<3> deformation = TensorOf<3>::Identity();
  Effort effort;                         // sum over the steps
  double cpu = 0;                        // of the thread, without pictures [s]
  grainlaw_status status = GRAINLAW_OK;  // of the failed evaluation
  std::string text = "done";             // or the reason of an early end
};

// Writes stem.csv, .svg, .png and the outputs that the scene asks for, and prints cost and files. A
// path that ends early, or is interrupted, keeps its results so far. Throws InputError,
// Interrupted, and ComputationError where the scene does not allow an early end; `end` then has the
// results so far.
void run_point(const PointScene& scene, const std::filesystem::path& stem, PointEnd& end);

}  // namespace verification
