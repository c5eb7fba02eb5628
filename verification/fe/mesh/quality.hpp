// Elements that cannot be computed with are found before anything else is done.
#pragma once

#include "fe/mesh/mesh.hpp"

#include <string>

namespace verification {

// Throws InputError naming the first element that is inverted, has a side folded onto another, or
// whose area shrinks to nothing somewhere. `place`: where the mesh stands in its scene.
void check_shapes(const Mesh& mesh, const std::string& place);

}  // namespace verification
