#include "fe/scene.hpp"

#include "app/history.hpp"
#include "fe/conditions/conditions_scene.hpp"
#include "fe/conditions/rigid_motion.hpp"
#include "fe/mesh/mesh_scene.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification {
namespace {

NewtonOptions read_newton(SceneTable table) {
  NewtonOptions options;
  options.tangent =
      tangent_bit(table.choice_or("tangent", "exact", {"exact", "elastic", "perturbed"}));
  options.tolerance = table.number_or("tolerance", options.tolerance, positive);
  options.max_cuts = table.integer_or("max_cuts", options.max_cuts, 0);
  options.loose_tolerance = table.number_or("loose_tolerance", 0, not_negative);
  options.max_iterations = table.integer_or("max_iterations", options.max_iterations, 1);
  table.close();
  return options;
}

}  // namespace

FiniteElementScene read_fe_scene(const SceneFile& file) {
  SceneTable table = file.root();
  FiniteElementScene scene;
  scene.name = table.text_or("name", file.path.stem().string());
  scene.material = read_material_source(table);
  if (table.has("newton")) scene.newton = read_newton(table.table("newton"));
  scene.threads = table.integer_or("threads", 0, 0);
  scene.steps = table.integer("steps", 1);
  scene.abscissa = table.choice_or("abscissa", axial_abscissa, {axial_abscissa, shear_abscissa});
  scene.checkpoint_every = table.integer_or("checkpoint_every", 0, 0);
  scene.vtk_every = table.integer_or("vtk_every", 0, 0);

  Model& model = scene.model;
  SceneTable mesh = table.table("mesh");
  model.mesh = read_mesh(mesh);
  model.hourglass = mesh.number_or("hourglass", model.hourglass, not_negative);
  mesh.close();
  read_conditions(table, scene.duration, model);
  check_held(model, file.path.string());
  table.close();
  return scene;
}

std::unique_ptr<Solver> make_solver(const FiniteElementScene& scene, const Material& material) {
  return make_newton_solver(scene.model, material, scene.newton, scene.threads);
}

}  // namespace verification
