// Solved conditions on small meshes: platens, resultants, periodic sides, tractions.
#include "fe/conditions/conditions_scene.hpp"
#include "fe/conditions/monitors.hpp"
#include "fe/mesh/mesh_scene.hpp"
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace verification {
namespace {

// Two cells wide and high, sides of length 1; forces per metre of thickness.
struct Solved {
  Solved(const std::string& conditions, const std::string& element, int steps = 1) {
    const toml::table content = toml::parse(
        "mesh = { element = '" + element + "', size = [1, 1], divisions = [2, 2] }\n" + conditions);
    SceneTable scene(content, "scene.toml", "");
    SceneTable mesh = scene.table("mesh");
    model.mesh = read_mesh(mesh);
    read_conditions(scene, 1, model);
    const Material material = lattice_material();
    const auto solver = make_newton_solver(model, material, {.tolerance = 1e-10}, 1);
    run_load_steps(*solver, 1, steps, steps,
                   [&](const LoadStep& found, const Solver&) { step = found; });
    displacement = solver->displacement();
  }
  [[nodiscard]] std::size_t at(const std::string& name) const {
    const auto monitors = make_monitors(model);
    for (std::size_t k = 0; k < monitors.size(); ++k)
      if (monitors[k].name == name) return k;
    ADD_FAILURE() << "no monitor " << name;
    return 0;
  }
  [[nodiscard]] double force(const std::string& name) const { return step.reactions[at(name)]; }
  [[nodiscard]] double motion(const std::string& name) const {
    return step.displacements[at(name)];
  }

  Model model;
  LoadStep step;
  Eigen::VectorXd displacement;
};

// The packing is at 100 kPa: 1e5 N/m on a side of 1 m holds it.
const std::string confined = R"(
[[displacement]]
on = "left"
component = "x"
value = 0.0
[[displacement]]
on = "bottom"
component = "y"
value = 0.0
[[pressure]]
on = "right"
value = 1e5
)";
const std::string bottom = R"(
[[displacement]]
on = "bottom"
component = "x"
value = 0.0
[[displacement]]
on = "bottom"
component = "y"
value = 0.0
)";

class platen : public testing::TestWithParam<const char*> {};

TEST_P(platen, a_resultant_gives_the_displacement_that_gives_the_resultant) {
  const std::string smooth = confined + "[[platen]]\non = 'top'\nsurface = 'smooth'\n";
  const Solved pushed(smooth + "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = -1e-4\n",
                      GetParam());
  const double force = pushed.force("top_y");
  EXPECT_LT(force, -1.01e5);
  const Solved loaded(smooth +
                          "[[resultant]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = " +
                          std::to_string(force) + "\n",
                      GetParam());
  EXPECT_NEAR(loaded.motion("top_y"), -1e-4, 1e-10);
  EXPECT_NEAR(loaded.force("top_y"), force, 1e-3);
  EXPECT_LT((loaded.displacement - pushed.displacement).norm(), 1e-9);
}

TEST_P(platen, a_rough_platen_moves_as_one_and_is_in_balance) {
  const Solved solved(
      bottom + "[[pressure]]\non = 'right'\nvalue = 1e5\n" +
          "[[pressure]]\non = 'left'\nvalue = 1e5\n" +
          "[[platen]]\non = 'top'\nsurface = 'rough'\n" +
          "[[resultant]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1.1e5\n" +
          "[[resultant]]\non = 'top'\ncomponent = 'x'\nvalue = 5e3\n",
      GetParam());
  for (const int node : solved.model.mesh.node_sets.at("top")) {
    EXPECT_NEAR(solved.displacement(2 * node), solved.motion("top_x"), 1e-15);
    EXPECT_NEAR(solved.displacement(2 * node + 1), solved.motion("top_y"), 1e-15);
  }
  EXPECT_GT(solved.motion("top_x"), 1e-6);
  EXPECT_NEAR(solved.force("top_x"), 5e3, 1e-3);
  // The sides turn, and the pressure with them: its resultant is that of the chord between the ends.
  EXPECT_NEAR(solved.force("bottom_x"), -5e3, 1e-3);
  EXPECT_NEAR(solved.force("bottom_y"), 1.1e5, 1e-3);
}

TEST_P(platen, periodic_sides_move_alike_and_hand_on_the_force) {
  const Solved solved(bottom + "[[periodic]]\nsides = ['left', 'right']\n" +
                          "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = 0.0\n" +
                          "[[displacement]]\non = 'top'\ncomponent = 'x'\nvalue = 1e-4\n",
                      GetParam());
  const Mesh& mesh = solved.model.mesh;
  for (const auto& [left, right] : solved.model.periodics[0].pairs)
    for (const int i : {0, 1})
      EXPECT_DOUBLE_EQ(solved.displacement(2 * left + i), solved.displacement(2 * right + i));
  // Simple shear is the same everywhere.
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
    EXPECT_NEAR(solved.displacement(2 * static_cast<Eigen::Index>(node)),
                1e-4 * mesh.nodes[node].y(), 1e-12);
  EXPECT_NEAR(solved.force("top_x"), -solved.force("bottom_x"), 1e-4);
  EXPECT_NEAR(solved.step.record.stress(0, 1), solved.force("top_x"), 1e-4);
}

TEST_P(platen, a_jump_stretches_periodic_sides) {
  const Solved solved(
      "[[displacement]]\non = 'bottom'\ncomponent = 'y'\nvalue = 0.0\n"
      "[[displacement]]\non = 'bottom_left'\ncomponent = 'x'\nvalue = 0.0\n"
      "[[displacement]]\non = 'bottom_right'\ncomponent = 'x'\nvalue = -1e-4\n"
      "[[periodic]]\nsides = ['left', 'right']\njump_x = { value = -1e-4 }\n"
      "[[pressure]]\non = 'top'\nvalue = 1e5\n",
      GetParam());
  EXPECT_NEAR(solved.motion("left_right_x"), -1e-4, 1e-18);
  EXPECT_NEAR(solved.step.record.deformation(0, 0), 1 - 1e-4, 1e-12);
  EXPECT_NEAR(solved.step.record.stress(0, 0), solved.force("left_right_x"), 1e-3);
  EXPECT_NEAR(solved.step.record.cauchy(1, 1), -1e5, 1e-3);
}

TEST_P(platen, tractions_make_the_stress) {
  const Solved solved(
      "[[displacement]]\non = 'left'\ncomponent = 'x'\nvalue = 0.0\n"
      "[[displacement]]\non = 'bottom'\ncomponent = 'y'\nvalue = 0.0\n"
      "[[traction]]\non = 'right'\ncomponent = 'x'\nstart = -1e5\nvalue = -1.1e5\n"
      "[[traction]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1.2e5\n",
      GetParam());
  EXPECT_NEAR(solved.step.record.stress(0, 0), -1.1e5, 1e-3);
  EXPECT_NEAR(solved.step.record.stress(1, 1), -1.2e5, 1e-3);
  EXPECT_NEAR(solved.force("left_x"), 1.1e5, 1e-3);
}

TEST_P(platen, newton_takes_few_iterations_under_every_kind_of_load) {
  const Solved solved(
      bottom +
          "[[platen]]\non = 'top'\nsurface = 'rough'\n"
          "[[resultant]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1.1e5\n"
          "[[resultant]]\non = 'top'\ncomponent = 'x'\nvalue = 5e3\n"
          "[[pressure]]\non = 'right'\nvalue = 1e5\n"
          "[[traction]]\non = 'left'\ncomponent = 'x'\nstart = 1e5\nvalue = 1e5\n",
      GetParam());
  EXPECT_LE(solved.step.record.effort.iterations, 5);
  EXPECT_EQ(solved.step.record.effort.cuts, 0);
}

INSTANTIATE_TEST_SUITE_P(kinds, platen, testing::Values("q4", "q4r", "q8", "t3"),
                         [](const auto& entry) { return std::string(entry.param); });

}  // namespace
}  // namespace verification
