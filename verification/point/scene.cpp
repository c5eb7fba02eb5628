#include "point/scene.hpp"

#include "app/cases.hpp"
#include "app/history.hpp"
#include "app/parts.hpp"
#include "point/figures.hpp"
#include "point/laboratory_test.hpp"
#include "point/start.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace verification {
namespace {

std::vector<double> read_pictures(SceneTable& table) {
  const toml::node* node = table.node("pictures");
  if (node == nullptr) return {};
  const std::size_t count = node->is_array() ? node->as_array()->size() : 1;
  std::vector<double> pictures = table.numbers("pictures", count, any_number);
  std::sort(pictures.begin(), pictures.end());
  return pictures;
}

// Default figures of the tests in a path.
std::vector<std::string> default_figures(const std::vector<Segment>& segments) {
  std::vector<std::string> figures;
  const auto add = [&](const char* name) {
    if (std::find(figures.begin(), figures.end(), name) == figures.end())
      figures.emplace_back(name);
  };
  for (const Segment& segment : segments) {
    if (!segment.test) continue;
    const TestKind kind = segment.test->kind;
    const bool compression = segment.test->led_by_stress() || kind == TestKind::oedometric;
    add(compression ? "e-log-p" : "p-q");
  }
  return figures;
}

std::vector<std::string> read_figures(SceneTable& table, const std::vector<Segment>& segments) {
  const toml::node* node = table.node("figures");
  if (node == nullptr) return default_figures(segments);
  std::vector<std::string> figures;
  const toml::array* array = node->as_array();
  const std::string expected = fmt::format("a list of {}", fmt::join(path_figures, ", "));
  if (array == nullptr) table.fail("figures", "no list", expected);
  for (const toml::node& item : *array) {
    const std::string name = item.value_or(std::string());
    if (std::find(path_figures.begin(), path_figures.end(), name) == path_figures.end())
      table.fail("figures", '"' + name + '"', expected);
    figures.push_back(name);
  }
  return figures;
}

bool is_shear(const std::vector<Segment>& segments) {
  return std::any_of(segments.begin(), segments.end(),
                     [](const Segment& segment) { return segment.test && segment.test->shear(); });
}

std::vector<std::string_view> abscissae(int dimension) {
  std::vector<std::string_view> names{axial_abscissa, shear_abscissa};
  if (dimension == 3) names.insert(names.end(), {"F13", "F23"});
  return names;
}

PointScene read_scene(SceneTable table, const std::string& name) {
  PointScene scene;
  scene.name = table.file_name_or("name", name);
  scene.material = read_material_source(table);
  scene.options.tangent =
      tangent_bit(table.choice_or("tangent", "exact", {"exact", "elastic", "perturbed"}));
  scene.options.tolerance = read_tolerance(table, scene.material, scene.options.tolerance);
  scene.options.max_iterations =
      table.integer_or("max_iterations", scene.options.max_iterations, 1);
  scene.options.max_cuts = table.integer_or("max_cuts", scene.options.max_cuts, 0, most_cuts);
  scene.options.loose_tolerance = table.number_or("loose_tolerance", 0, not_negative);
  scene.dimension = dimension_of(scene.material);
  scene.segments = read_segments(table, bears_tension(scene.material), scene.dimension);
  scene.shear = is_shear(scene.segments);
  const char* usual = !scene.shear ? axial_abscissa : scene.dimension == 3 ? "F13" : shear_abscissa;
  scene.abscissa = table.choice_or("abscissa", usual, abscissae(scene.dimension));
  scene.vtk_every = table.integer_or("vtk_every", 0, 0);
  scene.pictures = read_pictures(table);
  scene.picture_force = table.number_or("picture_force", 0, not_negative);
  scene.particle_measures = table.flag_or("particle_measures", false);
  scene.figure = table.flag_or("figure", true);
  scene.figures = read_figures(table, scene.segments);
  scene.may_end = table.flag_or("may_end", false);
  table.close();
  return scene;
}

}  // namespace

std::vector<PointScene> read_point_scenes(const SceneFile& file) {
  const std::string stem = file.path.stem().string();
  const std::vector<toml::table> cases = scene_cases(file);
  if (cases.empty()) return {read_scene(file.root(), stem)};
  std::vector<PointScene> scenes;
  for (const toml::table& content : cases)
    scenes.push_back(read_scene({content, file.path, ""}, stem));
  return scenes;
}

}  // namespace verification
