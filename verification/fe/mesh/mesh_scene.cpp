#include "fe/mesh/mesh_scene.hpp"

#include "fe/mesh/gmsh_file.hpp"
#include "fe/mesh/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

ElementKind read_element_kind(SceneTable& table, int dimension) {
  const auto kinds = element_kinds_of(dimension);
  std::vector<std::string_view> names;
  for (const ElementKind kind : kinds) names.push_back(element_type(kind).name);
  const std::string name = table.choice_or("element", names.front(), names);
  return *std::find_if(kinds.begin(), kinds.end(),
                       [&](ElementKind kind) { return element_type(kind).name == name; });
}

Mesh read_box(SceneTable& table, int dimension) {
  const auto axes = static_cast<std::size_t>(dimension);
  const Range counts{1, dimension == 2 ? 1e4 : 100, false,
                     dimension == 2 ? "an integer from 1 to 10000" : "an integer from 1 to 100"};
  const std::vector<double> size = table.numbers("size", axes, positive);
  std::vector<int> divisions;
  for (const double value : table.numbers("divisions", axes, counts)) {
    if (value != std::floor(value)) table.fail("divisions", fmt::format("{}", value), counts.text);
    divisions.push_back(static_cast<int>(value));
  }
  return box_mesh(size, divisions, read_element_kind(table, dimension));
}

// Reads a file, which has the kind of its elements; the scene may ask for another one on their nodes.
Mesh read_file(SceneTable& table, int dimension) {
  for (const char* key : {"size", "divisions"})
    if (table.has(key)) table.fail(key, fmt::format("both file and {}", key), "one of them");
  Mesh mesh = read_gmsh_mesh(table.file().parent_path() / table.text("file"));
  if (mesh.dimension() != dimension)
    table.fail("file", fmt::format("elements of dimension {}", mesh.dimension()),
               fmt::format("those of the material, {}", dimension));
  if (!table.has("element")) return mesh;
  const ElementKind wanted = read_element_kind(table, dimension);
  if (element_type(wanted).gmsh != element_type(mesh.kind).gmsh)
    table.fail("element", element_type(wanted).name,
               fmt::format("{}, as the file has them", element_type(mesh.kind).name));
  mesh.kind = wanted;
  return mesh;
}

}  // namespace

Mesh read_mesh(SceneTable& table, int dimension) {
  const Mesh mesh = table.has("file") ? read_file(table, dimension) : read_box(table, dimension);
  check_shapes(mesh, table.place());
  return mesh;
}

}  // namespace verification
