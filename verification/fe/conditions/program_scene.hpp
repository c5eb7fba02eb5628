// Programs in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/conditions/program.hpp"

namespace verification {

// Where a program given by its `value` at the end starts, unless `start` says it.
enum class Rise { from_zero, none };

// Reads one of `value` (and `start`), `path`, a list of [time, value] with increasing times within
// 0..duration, `half_sine = { amplitude, period, start }`, a pulse of half a period, or `sine =
// { amplitude, period, start, periods }`, to the end unless periods are given. Throws InputError.
Program read_program(SceneTable& table, double duration, Rise rise);

}  // namespace verification
