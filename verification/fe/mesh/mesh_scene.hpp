// Meshes in scene files.
#pragma once

#include "app/scene.hpp"
#include "fe/mesh/mesh.hpp"

namespace verification {

// The scene's `mesh`: element with size and divisions, or a file of Gmsh, relative to the scene.
// Throws InputError, also for badly shaped elements. Leaves other keys to the caller, who closes the table.
Mesh read_mesh(SceneTable& table);

}  // namespace verification
