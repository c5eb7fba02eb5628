// Conditions and loads in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/model.hpp"

namespace verification {

// Reads [[displacement]], [[tie]], [[platen]], [[periodic]], [[resultant]], [[pressure]] and
// [[traction]] for the model's mesh. Throws InputError.
void read_conditions(SceneTable& scene, double duration, Model& model);

}  // namespace verification
