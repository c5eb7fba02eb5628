// A scene of bricks from start to end, with its table and picture.
#pragma once

#include "app/scene.hpp"

#include <string>

namespace verification {

// Writes NAME.csv, .svg, .png to the directory. Ends after `stop_after` load steps where that is not
// negative. Throws InputError, ComputationError and Interrupted; what was reached stays written.
void run_brick_scene(const SceneFile& file, const std::string& directory, int stop_after);

}  // namespace verification
