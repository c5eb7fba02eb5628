#include "fe/scene.hpp"

#include "app/history.hpp"
#include "fe/conditions/conditions_scene.hpp"
#include "fe/conditions/dofs.hpp"
#include "fe/conditions/rigid_motion.hpp"
#include "fe/mesh/mesh_scene.hpp"
#include "fe/output/probe_scene.hpp"

#include <algorithm>
#include <utility>

namespace verification {

FiniteElementScene read_fe_scene(const SceneFile& file) {
  SceneTable table = file.root();
  FiniteElementScene scene;
  scene.name = table.file_name_or("name", file.path.stem().string());
  scene.material = read_material_source(table);
  scene.dimension = dimension_of(scene.material);
  scene.prestress = read_prestress(table, scene.material);
  scene.solver = read_solver(table, scene.material);
  const double duration = scene.solver.duration();
  scene.threads = table.integer_or("threads", 0, 0);
  scene.steps = table.integer("steps", 1);
  scene.solver.steps = scene.steps;
  scene.abscissa = table.choice_or("abscissa", axial_abscissa, abscissae(scene.dimension));

  Model& model = scene.model;
  SceneTable mesh = table.table("mesh");
  model.mesh = read_mesh(mesh, scene.dimension);
  model.hourglass = mesh.number_or("hourglass", model.hourglass, not_negative);
  model.average.length = mesh.number_or("average_length", 0, not_negative);
  if (model.average.length > 0) {
    if (model.mesh.kind == ElementKind::q4r)
      mesh.fail("average_length", "elements with one point and hourglass springs", "others");
    model.average.modulus = mesh.number_or("average_modulus", model.average.modulus, positive);
  }
  mesh.close();
  scene.output = read_output(table, model.mesh, scene.steps);
  for (SceneTable& entry : table.tables("probe")) {
    DisplacementProbe probe = read_probe(entry, model.mesh);
    if (std::any_of(scene.probes.begin(), scene.probes.end(),
                    [&](const DisplacementProbe& other) { return other.name == probe.name; }))
      entry.fail("name", '"' + probe.name + '"', "a name that no other probe has");
    scene.probes.push_back(std::move(probe));
  }
  if (scene.solver.kind != SolverKind::dynamics && table.has("cycle"))
    scene.cycle = read_cycle(table.table("cycle"), model);
  read_conditions(table, duration, model);
  check_loads_act(model, number_dofs(model));
  if (scene.solver.kind != SolverKind::dynamics) check_supports(model, file.path.string());
  table.close();
  return scene;
}

}  // namespace verification
