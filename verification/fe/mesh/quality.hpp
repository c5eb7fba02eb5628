// Check of element shapes before a run.
#pragma once

#include "fe/mesh/mesh.hpp"

#include <string>

namespace verification {

// Throws InputError that names the first element which is inverted, folded, or whose area vanishes
// somewhere. `place`: the mesh in its scene.
void check_shapes(const Mesh& mesh, const std::string& place);

}  // namespace verification
