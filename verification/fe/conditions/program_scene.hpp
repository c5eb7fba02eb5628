// Programs in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/conditions/program.hpp"

namespace verification {

// Default start of a program that is given by its `value` at the end.
enum class Rise { from_zero, none };

// Reads one of four forms. `value` (and `start`); `path`, a list of [time, value] with increasing
// times within 0..duration; `half_sine = { amplitude, period, start }`, half a period; `sine = {
// amplitude, period, start, periods }`, to the end by default. Throws InputError.
Program read_program(SceneTable& table, double duration, Rise rise);

}  // namespace verification
