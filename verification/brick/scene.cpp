#include "brick/scene.hpp"

#include "app/history.hpp"
#include "app/parts.hpp"
#include "brick/rigid_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace verification {
namespace {

BrickMesh read_mesh(SceneTable table) {
  constexpr int most = 100;
  const std::vector<double> size = table.numbers("size", 3, positive);
  const std::vector<double> divisions =
      table.numbers("divisions", 3, {1, most, false, "an integer from 1 to 100"});
  table.choice_or("element", "hex8", {"hex8"});
  table.close();
  std::array<int, 3> counts{};
  for (std::size_t k = 0; k < 3; ++k) counts[k] = static_cast<int>(divisions[k]);
  for (std::size_t k = 0; k < 3; ++k)
    if (counts[k] != divisions[k])
      table.fail("divisions", fmt::format("{:g}", divisions[k]), "an integer from 1 to 100");
  return make_box({size[0], size[1], size[2]}, counts);
}

BrickNewtonOptions read_newton(SceneTable table, const MaterialSource& material) {
  BrickNewtonOptions options;
  table.choice_or("tangent", "exact", {"exact"});
  options.tolerance = read_tolerance(table, material, options.tolerance);
  options.max_iterations = table.integer_or("max_iterations", options.max_iterations, 1);
  options.max_cuts = table.integer_or("max_cuts", options.max_cuts, 0, most_cuts);
  options.loose_tolerance = table.number_or("loose_tolerance", 0, not_negative);
  table.close();
  return options;
}

// A named set of the box.
template <class Sets>
const typename Sets::mapped_type& read_set(SceneTable& table, const Sets& sets) {
  const std::string name = table.text("on");
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, content] : sets) names.push_back(known);
  table.fail("on", '"' + name + '"', fmt::format("one of {}", fmt::join(names, ", ")));
}

int read_component(SceneTable& table) {
  const std::string name = table.text("component");
  if (name != "x" && name != "y" && name != "z")
    table.fail("component", '"' + name + '"', "one of x, y, z");
  return name[0] - 'x';
}

// Name of a condition, e.g. "top_z".
std::string name_of(SceneTable& table, int component) {
  return table.text("on") + '_' + "xyz"[component];
}

bool overlap(const std::vector<int>& a, const std::vector<int>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](int node) { return std::find(b.begin(), b.end(), node) != b.end(); });
}

void read_conditions(SceneTable& scene, BrickModel& model) {
  for (SceneTable& table : scene.tables("displacement")) {
    BrickModel::Displacement condition;
    condition.nodes = read_set(table, model.mesh.node_sets);
    condition.component = read_component(table);
    condition.name = name_of(table, condition.component);
    condition.value = table.number("value");
    for (const auto& other : model.displacements)
      if (other.component == condition.component && other.value != condition.value &&
          overlap(other.nodes, condition.nodes))
        table.fail("value", fmt::format("{:g}", condition.value),
                   fmt::format("{:g}, as nodes of this set have already", other.value));
    table.close();
    model.displacements.push_back(condition);
  }
  for (SceneTable& table : scene.tables("tie")) {
    BrickModel::Tie tie;
    tie.nodes = read_set(table, model.mesh.node_sets);
    tie.component = read_component(table);
    tie.name = name_of(table, tie.component);
    const auto taken = [&](const auto& other) {
      return other.component == tie.component && overlap(other.nodes, tie.nodes);
    };
    if (std::any_of(model.displacements.begin(), model.displacements.end(), taken) ||
        std::any_of(model.ties.begin(), model.ties.end(), taken))
      table.fail("on", "nodes whose displacement is prescribed or tied already", "another set");
    table.close();
    model.ties.push_back(tie);
  }
  for (SceneTable& table : scene.tables("pressure")) {
    model.pressures.push_back({read_set(table, model.mesh.faces), table.number("value")});
    table.close();
  }
}

}  // namespace

BrickScene read_brick_scene(const SceneFile& file) {
  SceneTable table = file.root();
  BrickScene scene;
  scene.name = table.file_name_or("name", file.path.stem().string());
  scene.material = read_material_source(table);
  table.choice_or("solver", "newton", {"newton"});
  static const toml::table none;
  scene.newton = read_newton(
      table.has("newton") ? table.table("newton") : SceneTable(none, file.path, "newton"),
      scene.material);
  scene.threads = table.integer_or("threads", 0, 0);
  scene.steps = table.integer("steps", 1);
  scene.newton.load_step = 1.0 / scene.steps;
  scene.abscissa =
      table.choice_or("abscissa", axial_abscissa, {axial_abscissa, shear_abscissa, "F13", "F23"});
  scene.model.mesh = read_mesh(table.table("mesh"));
  read_conditions(table, scene.model);
  table.close();
  if (const std::string motion = free_motion(scene.model); !motion.empty())
    table.fail("displacement", "nothing that holds " + motion,
               "[[displacement]] or [[tie]] that prevent every rigid motion");
  return scene;
}

}  // namespace verification
