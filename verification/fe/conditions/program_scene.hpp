// Programs in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/conditions/program.hpp"

namespace verification {

// Where a program given by its `value` at the end starts, unless `start` says it.
enum class Rise { from_zero, none };

// Reads either `value` (and `start`) or `path`, a list of [time, value] with increasing times within
// 0..duration. Throws InputError.
Program read_program(SceneTable& table, double duration, Rise rise);

}  // namespace verification
