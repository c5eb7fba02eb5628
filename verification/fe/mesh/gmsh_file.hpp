// Meshes of Gmsh.
#pragma once

#include "fe/mesh/mesh.hpp"

#include <filesystem>

namespace verification {

// Reads a mesh in any format of Gmsh: plane triangles of 3 or 6 nodes or quadrilaterals of 4 or 8;
// else, where it has solids, hexahedra of 8 or 20 nodes or tetrahedra of 10. Named physical groups
// of curves (of a solid: surfaces) become sets of nodes and of sides, those below sets of nodes.
// Nodes without an element are dropped. Throws InputError.
Mesh read_gmsh_mesh(const std::filesystem::path& path);

}  // namespace verification
