// Meshes in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/mesh/mesh.hpp"

namespace verification {

// Reads the scene's `mesh` of this dimension: element with size and divisions, or a Gmsh file
// relative to the scene. The caller reads other keys and closes the table. Throws InputError, also
// for badly shaped elements.
Mesh read_mesh(SceneTable& table, int dimension = 2);

}  // namespace verification
