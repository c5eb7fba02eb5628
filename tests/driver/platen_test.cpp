// Solved conditions on small meshes: platens, resultants, periodic sides, tractions.
#include "fe/conditions/conditions_scene.hpp"
#include "fe/conditions/monitors.hpp"
#include "fe/conditions/rigid_motion.hpp"
#include "fe/mesh/mesh_scene.hpp"
#include "fe/solver/newton.hpp"
#include "scene_text.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace verification {
namespace {

// Two cells wide and high, 1 m wide and unless told otherwise as high; forces per metre of thickness.
struct Solved {
  Solved(const std::string& conditions, const std::string& element,
         const std::string& height = "1") {
    const toml::table content = toml::parse("mesh = { element = '" + element + "', size = [1, " +
                                            height + "], divisions = [2, 2] }\n" + conditions)
                                    .table();
    SceneTable scene(content, "scene.toml", "");
    SceneTable mesh = scene.table("mesh");
    model.mesh = read_mesh(mesh);
    read_conditions(scene, 1, model);
    const Material material = lattice_material();
    const auto solver = make_newton_solver(model, material, {.tolerance = 1e-10}, 1);
    run_load_steps(*solver, 1, 1, 1, [&](const LoadStep& found, const Solver&) { step = found; });
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
const std::string confined = smooth_supports + "[[pressure]]\non = 'right'\nvalue = 1e5\n";

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
      held_bottom + "[[pressure]]\non = 'right'\nvalue = 1e5\n" +
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

// On the axis of symmetry a rough platen cannot go sideways: no condition says so but the axis.
TEST_P(platen, a_rough_platen_on_half_a_model_follows_the_axis) {
  const std::string pushed = confined + "[[platen]]\non = 'top'\nsurface = 'rough'\n" +
                             "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = -1e-4\n";
  const Solved half(pushed, GetParam());
  for (const int node : half.model.mesh.node_sets.at("top")) {
    EXPECT_EQ(half.displacement(2 * node), 0);
    EXPECT_NEAR(half.displacement(2 * node + 1), -1e-4, 1e-15);
  }
  const Solved held_too(pushed + held("top", "x"), GetParam());
  EXPECT_LT((half.displacement - held_too.displacement).norm(), 1e-12);
}

TEST_P(platen, periodic_sides_move_alike_and_hand_on_the_force) {
  const Solved solved(held_bottom + periodic_sides +
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
  const Solved solved(held("bottom", "y") + held("bottom_left", "x") +
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
      smooth_supports +
          "[[traction]]\non = 'right'\ncomponent = 'x'\nstart = -1e5\nvalue = -1.1e5\n"
          "[[traction]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1.2e5\n",
      GetParam());
  EXPECT_NEAR(solved.step.record.stress(0, 0), -1.1e5, 1e-3);
  EXPECT_NEAR(solved.step.record.stress(1, 1), -1.2e5, 1e-3);
  EXPECT_NEAR(solved.force("left_x"), 1.1e5, 1e-3);
}

TEST_P(platen, newton_takes_few_iterations_under_every_kind_of_load) {
  const Solved solved(
      held_bottom +
          "[[platen]]\non = 'top'\nsurface = 'rough'\n"
          "[[resultant]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1.1e5\n"
          "[[resultant]]\non = 'top'\ncomponent = 'x'\nvalue = 5e3\n"
          "[[pressure]]\non = 'right'\nvalue = 1e5\n"
          "[[traction]]\non = 'left'\ncomponent = 'x'\nstart = 1e5\nvalue = 1e5\n",
      GetParam());
  EXPECT_LE(solved.step.record.effort.iterations, 5);
  EXPECT_EQ(solved.step.record.effort.cuts, 0);
}

// Pure bending of a block with smooth ends and free sides: top and bottom stay straight, and beam
// theory is exact: angle = height dM / (E' b^3 / 12) where dF = -E' b settlement / height. The block is
// low, for the pressure on it, 1/500 of its modulus, bends it further by that times 12 (height / b)^2.
TEST(platen_on_a_hinge, turns_by_the_angle_of_pure_bending) {
  const std::string block =
      held("bottom", "y") + held("bottom_left", "x") +
      "[[traction]]\non = 'left'\ncomponent = 'x'\nstart = 1e5\nvalue = 1e5\n"
      "[[traction]]\non = 'right'\ncomponent = 'x'\nstart = -1e5\nvalue = -1e5\n"
      "[[platen]]\non = 'top'\nrotation = 'free'\n";
  const std::string load =
      "[[resultant]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1.001e5\n";
  const Solved centred(block + load, "q8", "0.2");
  EXPECT_NEAR(centred.motion("top_hinge"), 0, 1e-9);
  EXPECT_NEAR(centred.force("top_y"), -1.001e5, 1e-4);
  // The load at rest in the middle, 100 N/m more 0.05 m beside it: as one load on a hinge between.
  const double eccentricity = 0.05;
  const double hinge = 0.5 + eccentricity;
  const Solved bent("[[traction]]\non = 'top'\ncomponent = 'y'\nstart = -1e5\nvalue = -1e5\n" +
                        block + "hinge = " + std::to_string(hinge) +
                        "\n[[resultant]]\non = 'top'\ncomponent = 'y'\nvalue = -100\n",
                    "q8", "0.2");
  const double settlement = -centred.motion("top_y");
  EXPECT_GT(settlement, 1e-8);
  const double angle = -12 * eccentricity * settlement;  // clockwise
  EXPECT_NEAR(bent.motion("top_hinge"), angle, 1e-3 * std::abs(angle));
  EXPECT_NEAR(bent.motion("top_y"), -settlement + angle * eccentricity,
              1e-3 * std::abs(angle) * eccentricity + 1e-3 * settlement);
  EXPECT_NEAR(bent.force("top_hinge"), 0, 1e-3);
  for (const int node : bent.model.mesh.node_sets.at("top")) {
    const double arm = bent.model.mesh.nodes[static_cast<std::size_t>(node)].x() - hinge;
    EXPECT_NEAR(bent.displacement(2 * node + 1),
                bent.motion("top_y") + bent.motion("top_hinge") * arm, 1e-15);
  }
}

TEST(platen_on_a_hinge, pushed_down_turns_as_the_weaker_side_yields) {
  const std::string supports =
      held_bottom +
      "[[pressure]]\non = 'left'\nvalue = 1e5\n[[pressure]]\non = 'right'\nvalue = 0.9e5\n";
  const Solved solved(supports +
                          "[[platen]]\non = 'top'\nsurface = 'rough'\nrotation = 'free'\n"
                          "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = -1e-4\n",
                      "q4");
  EXPECT_NEAR(solved.motion("top_y"), -1e-4, 1e-15);
  EXPECT_GT(std::abs(solved.motion("top_hinge")), 1e-7);
  EXPECT_NEAR(solved.force("top_hinge"), 0, 1e-4);
  EXPECT_LE(solved.step.record.effort.iterations, 5);
}

TEST(platen_on_a_hinge, does_not_hold_the_specimen_against_turning) {
  const auto held = [](const std::string& rotation) {
    const toml::table content =
        toml::parse(
            "mesh = { size = [1, 1], divisions = [2, 2] }\n"
            "[[platen]]\non = 'top'\nrotation = '" +
            rotation +
            "'\n"
            "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = 0.0\n"
            "[[displacement]]\non = 'bottom_left'\ncomponent = 'x'\nvalue = 0.0\n")
            .table();
    SceneTable scene(content, "scene.toml", "");
    Model model;
    SceneTable mesh = scene.table("mesh");
    model.mesh = read_mesh(mesh);
    read_conditions(scene, 1, model);
    check_supports(model, "scene.toml");
  };
  EXPECT_NO_THROW(held("fixed"));
  try {
    held("free");
    ADD_FAILURE() << "a hinge held it";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("holds rotation about (0.5, 0)"), std::string::npos)
        << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(kinds, platen, testing::Values("q4", "q4r", "q8", "t3"),
                         [](const auto& entry) { return std::string(entry.param); });

}  // namespace
}  // namespace verification
