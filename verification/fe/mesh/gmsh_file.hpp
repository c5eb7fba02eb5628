// Meshes made by Gmsh.
#pragma once

#include "fe/mesh/mesh.hpp"

#include <filesystem>

namespace verification {

// A plane mesh of 3-node triangles, or of 4- or 8-node quadrilaterals, in any format of Gmsh. Named
// physical groups of curves become sets of nodes and of sides, those of points sets of nodes. Nodes
// that no element has are left out. Throws InputError.
Mesh read_gmsh_mesh(const std::filesystem::path& path);

}  // namespace verification
