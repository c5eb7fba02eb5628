// A scene of bricks from start to end, with its table and picture.
#pragma once

#include "app/output.hpp"
#include "app/scene.hpp"

namespace verification {

// Writes NAME.csv, .svg, .png to the directory. Ends after `stop_after` load steps where that is not
// negative. Throws InputError, ComputationError and Interrupted; what was reached stays written.
void run_brick_scene(const SceneFile& file, const Destination& destination, int stop_after);

}  // namespace verification
