#include "fe/mesh/mesh_scene.hpp"

#include "fe/mesh/gmsh_file.hpp"
#include "fe/mesh/quality.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification {
namespace {

ElementKind read_element_kind(SceneTable& table) {
  const std::string name = table.choice_or("element", "q4", {"q4", "q4fbar", "q4r", "q8", "t3"});
  for (const auto kind : {ElementKind::q4fbar, ElementKind::q4r, ElementKind::q8, ElementKind::t3})
    if (name == element_type(kind).name) return kind;
  return ElementKind::q4;
}

Mesh read_rectangle(SceneTable& table) {
  constexpr Range counts{1, 1e4, false, "an integer >= 1"};
  const std::vector<double> size = table.numbers("size", 2, positive);
  const std::vector<double> divisions = table.numbers("divisions", 2, counts);
  for (const double value : divisions)
    if (value != std::floor(value)) table.fail("divisions", fmt::format("{}", value), counts.text);
  return rectangle_mesh({size[0], size[1]},
                        {static_cast<int>(divisions[0]), static_cast<int>(divisions[1])},
                        read_element_kind(table));
}

// Reads a file, which has the kind of its elements; for q4 the scene may ask for q4r or q4fbar.
Mesh read_file(SceneTable& table) {
  for (const char* key : {"size", "divisions"})
    if (table.has(key)) table.fail(key, fmt::format("both file and {}", key), "one of them");
  Mesh mesh = read_gmsh_mesh(table.file().parent_path() / table.text("file"));
  if (!table.has("element")) return mesh;
  const ElementKind wanted = read_element_kind(table);
  const bool quadrilateral = wanted == ElementKind::q4r || wanted == ElementKind::q4fbar;
  if (quadrilateral && mesh.kind == ElementKind::q4) mesh.kind = wanted;
  if (wanted != mesh.kind)
    table.fail("element", element_type(wanted).name,
               fmt::format("{}, as the file has them", element_type(mesh.kind).name));
  return mesh;
}

}  // namespace

Mesh read_mesh(SceneTable& table) {
  const Mesh mesh = table.has("file") ? read_file(table) : read_rectangle(table);
  check_shapes(mesh, table.place());
  return mesh;
}

}  // namespace verification
