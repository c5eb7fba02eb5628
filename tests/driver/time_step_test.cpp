// What solvers tell their points of time: a part of a load step is the shorter for it, so that its drag
// does not depend on how the step is cut; and that what has drag goes on as it went.
#include "../data.hpp"
#include "fe/solver/last_displacement.hpp"
#include "fe/solver/newton.hpp"
#include "fe/solver/relaxation.hpp"
#include "point/driver.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

namespace verification {
namespace {

// The 400 discs with drag that remembers for the time `memory`; 0: the strain is the time.
Material with_drag(double memory) {
  MaterialSource source;
  source.file = grainlaw::test::data_file("rve400.toml");
  source.base = grainlaw::test::data_folder();
  constexpr double number = 1e-3;
  toml::table solver{{"viscous_number", number}};
  if (memory > 0) solver.insert("viscous_rate", number / memory);
  source.changes.insert("solver", std::move(solver));
  return make_material(source);
}

Model specimen(double strain) {
  Model model;
  model.mesh = box_mesh({0.05, 0.1}, {1, 1}, ElementKind::q4r);
  const auto& sets = model.mesh.node_sets;
  model.displacements.push_back({sets.at("left"), 0, Program{{{0, 0}}, {}}, "left_x"});
  model.displacements.push_back({sets.at("bottom"), 1, Program{{{0, 0}}, {}}, "bottom_y"});
  model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -0.1 * strain), "top_y"});
  model.loads.pressures.push_back({model.mesh.side_sets["right"], Program{{{0, 1e5}}, {}}, true});
  return model;
}

using MakeSolver = std::unique_ptr<Solver> (*)(const Model&, const Material&);

std::unique_ptr<Solver> newton(const Model& model, const Material& material) {
  return make_newton_solver(model, material, {.tolerance = 1e-8}, 1);
}
std::unique_ptr<Solver> relaxation(const Model& model, const Material& material) {
  return make_relaxation_solver(model, material, {.tolerance = 1e-8}, 1);
}

// The force on top at the end, reached in quarters.
double force_in_quarters(MakeSolver make, double load_step, double memory) {
  const Model model = specimen(2e-3);
  const Material material = with_drag(memory);
  const auto solver = make(model, material);
  solver->set_load_step(load_step);
  LoadStep last;
  for (int quarter = 1; quarter <= 4; ++quarter) last = solver->advance(0.25 * quarter, quarter);
  EXPECT_EQ(last.record.effort.cuts, 0);
  return last.reactions.back();
}

TEST(time_step, a_part_of_a_load_step_lasts_its_share_of_it) {
  for (const MakeSolver make : {newton, relaxation}) {
    const double quarters = force_in_quarters(make, 1, 1);
    EXPECT_EQ(force_in_quarters(make, 0.25, 4), quarters);
    EXPECT_GT(std::abs(force_in_quarters(make, 0.25, 1) - quarters), 1e-5 * std::abs(quarters));
  }
}

// Without `viscous_rate` the strain is the time.
TEST(time_step, is_nothing_to_points_that_do_not_ask_for_it) {
  EXPECT_EQ(force_in_quarters(newton, 1, 0), force_in_quarters(newton, 0.25, 0));
}

TEST(time_step, a_path_that_is_cut_has_the_drag_of_its_time) {
  const auto axial = [](double memory, int steps, int max_iterations, int cuts) {
    PointDriver driver(with_drag(memory), {.tolerance = 1e-7, .max_iterations = max_iterations});
    int found = 0;
    driver.run(drained_segment(-2e-3, -1e5, steps),
               [&](const PointStep& step) { found += step.record.effort.cuts; });
    EXPECT_GE(found, cuts);
    return driver.record().cauchy(1, 1);
  };
  const double whole = axial(1, 2, 20, 0);
  EXPECT_NEAR(axial(1, 2, 2, 1), whole, 2e-3 * std::abs(whole));
}

// Past the peak and back: fewer iterations are of meshes, the forces are those of any guess.
TEST(last_displacement, leads_to_the_forces_of_another_guess) {
  Model model = specimen(0.03);
  model.displacements.back().value = {{{0, 0}, {0.9, -3e-3}, {1, -2.9e-3}}, {}};
  const Material material = with_drag(1);
  const auto forces = [&](bool last_displacement_first) {
    const auto solver = make_newton_solver(
        model, material, {.tolerance = 1e-8, .last_displacement_first = last_displacement_first},
        1);
    solver->set_load_step(1.0 / 30);
    std::vector<double> found;
    for (int step = 1; step <= 30; ++step)
      found.push_back(solver->advance(step / 30.0, step).reactions.back());
    return found;
  };
  const std::vector<double> tangent = forces(false), repeated = forces(true);
  for (std::size_t k = 0; k < tangent.size(); ++k)
    EXPECT_NEAR(repeated[k], tangent[k], 1e-4 * std::abs(tangent.front())) << k;
}

TEST(last_displacement, is_no_guess_where_what_is_prescribed_goes_another_way) {
  LastDisplacement move;
  const Eigen::Vector2d moved(3, 4), down(1, 0), aside(0, 1);
  EXPECT_EQ(move.once_more(down).size(), 0);
  move.keep(moved, down);
  EXPECT_EQ(move.once_more(0.5 * down), 0.5 * moved);
  for (const Eigen::Vector2d& other : {aside, Eigen::Vector2d(-down), Eigen::Vector2d(4 * down)})
    EXPECT_EQ(move.once_more(other).size(), 0);
}

}  // namespace
}  // namespace verification
