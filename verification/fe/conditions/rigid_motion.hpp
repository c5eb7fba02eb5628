// Check of a model's supports against rigid motions.
#pragma once

#include <string>

namespace verification {

struct Model;

// Throws InputError that names a rigid motion which no condition prevents. For statics only: a body
// in motion needs no supports. `place`: the scene.
void check_supports(const Model& model, const std::string& place);

}  // namespace verification
