#include "fe/scene.hpp"

#include "app/history.hpp"
#include "fe/conditions/program_scene.hpp"
#include "fe/output/probe_scene.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification {
namespace {

const std::vector<std::string_view> edges{"left", "right", "bottom", "top", "bottom_left", "bottom_right", "top_left", "top_right"};

ElementKind read_element_kind(SceneTable& table) {
  const std::string name = table.choice_or("element", "q4", {"q4", "q4r", "q8", "t3"});
  for (const auto kind : {ElementKind::q4r, ElementKind::q8, ElementKind::t3})
    if (name == element_type(kind).name) return kind;
  return ElementKind::q4;
}

Mesh read_mesh(SceneTable& table) {
  constexpr Range counts{1, 1e4, false, "an integer >= 1"};
  const std::vector<double> size = table.numbers("size", 2, positive);
  const std::vector<double> divisions = table.numbers("divisions", 2, counts);
  for (const double value : divisions)
    if (value != std::floor(value)) table.fail("divisions", fmt::format("{}", value), counts.text);
  const ElementKind kind = read_element_kind(table);
  return rectangle_mesh({size[0], size[1]},
                        {static_cast<int>(divisions[0]), static_cast<int>(divisions[1])}, kind);
}

std::string read_edge(SceneTable& table) {
  const std::string edge = table.text("on");
  return table.choice_or("on", edge, edges);
}

int read_component(SceneTable& table) {
  const std::string component = table.text("component");
  return table.choice_or("component", component, {"x", "y"}) == "x" ? 0 : 1;
}

}  // namespace

FiniteElementScene read_fe_scene(const SceneFile& file) {
  SceneTable table = file.root();
  FiniteElementScene scene;
  scene.name = table.text_or("name", file.path.stem().string());
  scene.material = read_material_source(table);
  scene.solver = read_solver(table);
  const double duration = scene.solver.duration();
  scene.threads = table.integer_or("threads", 0, 0);
  scene.steps = table.integer("steps", 1);
  scene.abscissa = table.choice_or("abscissa", axial_abscissa, {axial_abscissa, shear_abscissa});

  Model& model = scene.model;
  SceneTable mesh = table.table("mesh");
  model.mesh = read_mesh(mesh);
  model.hourglass = mesh.number_or("hourglass", model.hourglass, not_negative);
  mesh.close();
  scene.output = read_output(table, model.mesh, scene.steps);
  for (SceneTable& entry : table.tables("displacement")) {
    PrescribedDisplacement condition;
    const std::string edge = read_edge(entry);
    condition.nodes = model.mesh.node_sets[edge];
    condition.component = read_component(entry);
    condition.name = edge + (condition.component == 0 ? "_x" : "_y");
    condition.value = read_program(entry, duration, Rise::from_zero);
    entry.close();
    model.displacements.push_back(condition);
  }
  for (SceneTable& entry : table.tables("probe"))
    scene.probes.push_back(read_probe(entry, model.mesh));
  for (SceneTable& entry : table.tables("tie")) {
    model.ties.push_back({model.mesh.node_sets[read_edge(entry)], read_component(entry)});
    entry.close();
  }
  for (SceneTable& entry : table.tables("pressure")) {
    Pressure pressure;
    pressure.sides = model.mesh.side_sets[read_edge(entry)];
    pressure.value = read_program(entry, duration, Rise::none);
    pressure.follows = entry.choice_or("kind", "follower", {"follower", "dead"}) == "follower";
    entry.close();
    model.loads.pressures.push_back(pressure);
  }
  for (SceneTable& entry : table.tables("traction")) {
    Traction traction;
    traction.sides = model.mesh.side_sets[read_edge(entry)];
    traction.component = read_component(entry);
    traction.value = read_program(entry, duration, Rise::from_zero);
    entry.close();
    model.loads.tractions.push_back(traction);
  }
  table.close();
  return scene;
}

}  // namespace verification
