#include "fe/solver/solver_scene.hpp"

#include "app/parts.hpp"

#include <fmt/format.h>

namespace verification {
namespace {

NewtonOptions read_newton(SceneTable table, const MaterialSource& material) {
  NewtonOptions options;
  options.tangent =
      tangent_bit(table.choice_or("tangent", "exact", {"exact", "elastic", "perturbed"}));
  options.tolerance = read_tolerance(table, material, options.tolerance);
  options.max_cuts = table.integer_or("max_cuts", options.max_cuts, 0, most_cuts);
  options.loose_tolerance = table.number_or("loose_tolerance", 0, not_negative);
  options.patience = table.integer_or("patience", options.patience, 1);
  options.largest_correction =
      table.number_or("largest_correction", options.largest_correction, not_negative);
  options.max_iterations = table.integer_or("max_iterations", options.max_iterations, 1);
  options.line_search = table.integer_or("line_search", 0, 0);
  options.elastic_share = table.number_or("elastic_share", 0, {0, 1, false, "a number in [0, 1]"});
  options.last_displacement_first =
      table.choice_or("first_guess", "tangent", {"tangent", "last_move"}) == "last_move";
  table.close();
  return options;
}

RelaxationOptions read_relaxation(SceneTable table) {
  RelaxationOptions options;
  options.tolerance = table.number_or("tolerance", options.tolerance, positive);
  options.max_iterations = table.integer_or("max_iterations", options.max_iterations, 1);
  options.max_cuts = table.integer_or("max_cuts", options.max_cuts, 0, most_cuts);
  options.damping_ratio = table.number_or("damping_ratio", options.damping_ratio, not_negative);
  options.safety = table.number_or("safety", options.safety, {0, 1, true, "a number in (0, 1]"});
  table.close();
  return options;
}

void read_dynamics(SceneTable table, SolverOptions& options) {
  DynamicsOptions& dynamics = options.dynamics;
  dynamics.duration = table.number("duration", positive);
  if (table.has("density") == table.has("particle_density"))
    table.fail("density", table.has("density") ? "particle_density too" : "nothing",
               "either density, mass per volume of the specimen, or particle_density [kg/m3]");
  dynamics.density = table.number_or("density", 0, positive);
  options.particle_density = table.number_or("particle_density", 0, positive);
  if (table.has("time_step") && table.has("safety"))
    table.fail("safety", "time_step too", "one of them");
  dynamics.time_step = table.number_or("time_step", 0, positive);
  dynamics.safety = table.number_or("safety", dynamics.safety, {0, 1, true, "a number in (0, 1]"});
  dynamics.damping = table.number_or("damping", 0, not_negative);
  table.close();
}

}  // namespace

SolverOptions read_solver(SceneTable& scene, const MaterialSource& material) {
  SolverOptions options;
  const std::string kind =
      scene.choice_or("solver", "newton", {"newton", "relaxation", "dynamics"});
  for (const char* other : {"newton", "relaxation", "dynamics"})
    if (other != kind && scene.has(other))
      scene.fail(other, "a table", fmt::format("none with solver = \"{}\"", kind));
  if (kind == "dynamics") {
    options.kind = SolverKind::dynamics;
    read_dynamics(scene.table("dynamics"), options);
  } else if (kind == "relaxation") {
    options.kind = SolverKind::relaxation;
    if (scene.has(kind)) options.relaxation = read_relaxation(scene.table(kind));
  } else {
    static const toml::table none;
    options.newton = read_newton(
        scene.has(kind) ? scene.table(kind) : SceneTable(none, scene.file(), kind), material);
  }
  return options;
}

std::unique_ptr<Solver> make_solver(const SolverOptions& options, const Model& model,
                                    const Material& material, int threads) {
  if (options.kind != SolverKind::dynamics) {
    auto solver = options.kind == SolverKind::newton
                      ? make_newton_solver(model, material, options.newton, threads)
                      : make_relaxation_solver(model, material, options.relaxation, threads);
    solver->set_load_step(options.duration() / options.steps);
    return solver;
  }
  DynamicsOptions dynamics = options.dynamics;
  if (options.particle_density > 0) {
    const double void_ratio = measure_scalar(State(material).get(), GRAINLAW_VOID_RATIO);
    dynamics.density = options.particle_density / (1 + void_ratio);
  }
  return make_dynamics_solver(model, material, dynamics, threads);
}

}  // namespace verification
