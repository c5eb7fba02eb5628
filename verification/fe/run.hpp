// A run of a finite element scene from beginning to end, or from where an interrupted one was left.
#pragma once

#include "app/output.hpp"
#include "fe/scene.hpp"

#include <optional>

namespace verification {

struct RunOptions {
  Destination destination;              // of the results
  bool restart = false;                 // go on from the checkpoint, if there is one
  std::optional<int> checkpoint_every;  // instead of the scene's; 0: when interrupted only
  std::optional<int> stop_after;        // end with a checkpoint after this load step
};

// Writes the files that `grainlaw solve` documents. Between two load steps it looks whether it has
// been asked to end: it then leaves NAME.checkpoint and throws Interrupted. Throws InputError and
// ComputationError.
void run_fe_scene(const SceneFile& file, const RunOptions& options);

}  // namespace verification
