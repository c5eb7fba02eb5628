// Whether the conditions of a body of bricks hold it against moving as a whole.
#pragma once

#include <string>

namespace verification {

struct BrickModel;

// A rigid motion that no condition prevents, or how many there are of them; "": none.
std::string free_motion(const BrickModel& model);

}  // namespace verification
