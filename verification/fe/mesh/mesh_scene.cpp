#include "fe/mesh/mesh_scene.hpp"

#include "fe/mesh/quality.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification {
namespace {

ElementKind read_element_kind(SceneTable& table) {
  const std::string name = table.choice_or("element", "q4", {"q4", "q4r", "q8", "t3"});
  for (const auto kind : {ElementKind::q4r, ElementKind::q8, ElementKind::t3})
    if (name == element_type(kind).name) return kind;
  return ElementKind::q4;
}

}  // namespace

Mesh read_mesh(SceneTable& table) {
  constexpr Range counts{1, 1e4, false, "an integer >= 1"};
  const std::vector<double> size = table.numbers("size", 2, positive);
  const std::vector<double> divisions = table.numbers("divisions", 2, counts);
  for (const double value : divisions)
    if (value != std::floor(value)) table.fail("divisions", fmt::format("{}", value), counts.text);
  const Mesh mesh = rectangle_mesh({size[0], size[1]},
                                   {static_cast<int>(divisions[0]), static_cast<int>(divisions[1])},
                                   read_element_kind(table));
  check_shapes(mesh, table.place());
  return mesh;
}

}  // namespace verification
