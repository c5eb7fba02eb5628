// Run of a scene of bricks, with its table and picture.
#pragma once

#include "app/output.hpp"
#include "app/scene.hpp"

namespace verification {

// Writes NAME.csv, .svg, .png to the directory. Ends after `stop_after` load steps unless that is
// negative. Throws InputError, ComputationError and Interrupted; results so far stay written.
void run_brick_scene(const SceneFile& file, const Destination& destination, int stop_after);

}  // namespace verification
