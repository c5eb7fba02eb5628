// Meshes of Gmsh.
#pragma once

#include "fe/mesh/mesh.hpp"

#include <filesystem>

namespace verification {

// Reads a plane mesh of 3-node triangles, or of 4- or 8-node quadrilaterals, in any format of Gmsh.
// Named physical groups of curves become sets of nodes and of sides, those of points sets of nodes.
// Nodes without an element are dropped. Throws InputError.
Mesh read_gmsh_mesh(const std::filesystem::path& path);

}  // namespace verification
