// Whether the conditions of a model hold it against moving as a whole.
#pragma once

#include <string>

namespace verification {

struct Model;

// Throws InputError naming a rigid motion that no condition prevents. Statics only: a body that is
// pushed may fly. `place`: the scene.
void check_held(const Model& model, const std::string& place);

}  // namespace verification
