// Gmsh's own library, loaded at run time when a scene names a mesh file. It costs a tenth of a
// second and ninety libraries, which other scenes do not pay.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Elements of one Gmsh type: tags of their nodes, `nodes` per element.
struct GmshElements {
  int type = 0;
  std::size_t nodes = 1;
  std::vector<std::size_t> tags;
};

struct GmshGroup {
  int dimension;
  std::string name;
  std::vector<GmshElements> elements;
};

struct GmshContent {
  std::vector<std::size_t> node_tags;
  std::vector<std::array<double, 3>> node_positions;  // [m]
  int dimension = 2;                                  // 3: there are solids
  std::vector<GmshElements> elements;                 // all of that dimension
  std::vector<GmshGroup> groups;                      // named physical groups
};

// Throws InputError for a file that Gmsh cannot read, and in a program built without Gmsh.
GmshContent read_gmsh(const std::filesystem::path& path);

}  // namespace verification
