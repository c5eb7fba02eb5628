// Run of a finite element scene from its start, or from a checkpoint.
#pragma once

#include "app/output.hpp"
#include "fe/scene.hpp"

#include <optional>

namespace verification {

struct RunOptions {
  Destination destination;              // of the results
  bool restart = false;                 // from the checkpoint, if there is one
  std::optional<int> checkpoint_every;  // replaces the scene's; 0: only at an interrupt
  std::optional<int> stop_after;        // load step after which the run ends with a checkpoint
};

// Writes the files that `grainlaw solve` documents. An interrupt is handled between load steps: it
// leaves NAME.checkpoint and throws Interrupted. Throws InputError and ComputationError.
void run_fe_scene(const SceneFile& file, const RunOptions& options);

}  // namespace verification
