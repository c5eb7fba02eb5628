// Conditions of scenes: what they do to the unknowns, and what is refused.
#include "fe/conditions/conditions_scene.hpp"
#include "fe/conditions/dofs.hpp"
#include "fe/conditions/rigid_motion.hpp"
#include "fe/mesh/mesh_scene.hpp"
#include "fe/mesh/quality.hpp"

#include "scene_text.hpp"

#include <gtest/gtest.h>

#include <string>

namespace verification {
namespace {

Model read_model(const std::string& conditions, const std::string& element = "q4") {
  const toml::table content = toml::parse("mesh = { element = '" + element +
                                          "', size = [2, 1], divisions = [2, 2] }\n" + conditions)
                                  .table();
  SceneTable scene(content, "scene.toml", "");
  SceneTable mesh = scene.table("mesh");
  Model model;
  model.mesh = read_mesh(mesh);
  read_conditions(scene, 1, model);
  check_loads_act(model, number_dofs(model));
  check_supports(model, "scene.toml");
  return model;
}

// The message that refuses the conditions.
std::string refusal(const std::string& conditions) {
  try {
    read_model(conditions);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

void expect_refusal(const std::string& conditions, const std::vector<std::string>& parts) {
  const std::string message = refusal(conditions);
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
}

TEST(conditions, cyclic_shear_with_periodic_sides_and_a_rough_platen_has_its_unknowns) {
  const Model model = read_model(held_bottom + periodic_sides + R"(
[[platen]]
on = "top"
surface = "rough"
[[displacement]]
on = "top"
component = "y"
value = 0.0
[[resultant]]
on = "top"
component = "x"
value = 10.0
)");
  // The platen's x, and x and y of the middle row, whose ends are one.
  EXPECT_EQ(number_dofs(model).unknowns, 1 + 2 * 2);
}

TEST(conditions, prescribed_values_and_jumps_add_up) {
  const Model model = read_model(R"(
[[displacement]]
on = "bottom_left"
component = "x"
value = 1.0
[[displacement]]
on = "bottom_right"
component = "x"
value = 4.0
[[displacement]]
on = "bottom"
component = "y"
value = 0.0
[[periodic]]
sides = ["left", "right"]
jump_x = { value = 3.0 }
)");
  const Dofs dofs = number_dofs(model);
  Eigen::VectorXd displacement = dofs.prescribed_at(0.5);
  for (int d = 0; d < dofs.unknowns; ++d)
    displacement += dofs.expand(Eigen::VectorXd::Unit(dofs.unknowns, d));
  for (const auto& [left, right] : model.periodics[0].pairs) {
    EXPECT_DOUBLE_EQ(displacement(2 * right) - displacement(2 * left), 1.5);
    EXPECT_DOUBLE_EQ(displacement(2 * right + 1) - displacement(2 * left + 1), 0);
  }
  EXPECT_DOUBLE_EQ(displacement(0), 0.5);
  EXPECT_DOUBLE_EQ(displacement(2 * 2), 2);
}

TEST(conditions, reduction_is_the_transpose_of_expansion) {
  const Model model = read_model(
      held_bottom + periodic_sides + "[[platen]]\non = 'top'\nsurface = 'rough'\n", "q8");
  const Dofs dofs = number_dofs(model);
  const Eigen::VectorXd unknowns = Eigen::VectorXd::LinSpaced(dofs.unknowns, 1, 2);
  const Eigen::VectorXd forces =
      Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(dofs.unknown.size()), -3, 5);
  EXPECT_NEAR(forces.dot(dofs.expand(unknowns)), dofs.reduce(forces).dot(unknowns), 1e-12);
}

TEST(conditions, an_unknown_set_is_refused_with_those_there_are) {
  expect_refusal("[[displacement]]\non = 'lid'\ncomponent = 'x'\nvalue = 0.0",
                 {"scene.toml:3", "displacement[1].on", "\"lid\"", "top_left"});
  expect_refusal(held_bottom + "[[traction]]\non = 'bottom_left'\ncomponent = 'x'\nvalue = 0.0",
                 {"scene.toml:12", "bottom_left", "left, right, top"});
}

TEST(conditions, a_missing_key_is_told_with_the_one_that_may_be_meant_for_it) {
  expect_refusal("[[displacement]]\non = 'top'\ncomponnt = 'y'\nvalue = 0.0",
                 {"displacement[1].component: found nothing", "(componnt in line "});
}

TEST(conditions, a_load_on_a_side_that_is_prescribed_in_its_direction_is_refused) {
  const std::string pressure = "[[pressure]]\non = 'left'\nvalue = 1e5\n";
  expect_refusal(smooth_supports + pressure,
                 {"scene.toml:10: pressure[1]", "wherever the load acts"});
  expect_refusal(smooth_supports + "[[traction]]\non = 'bottom'\ncomponent = 'y'\nvalue = 1e5\n",
                 {"traction[1]"});
  EXPECT_NO_THROW(read_model(held_bottom + pressure));
  EXPECT_NO_THROW(
      read_model(smooth_supports + "[[traction]]\non = 'bottom'\ncomponent = 'x'\nvalue = 1e5\n"));
}

TEST(conditions, a_displacement_that_is_not_zero_at_the_start_is_refused) {
  expect_refusal(held_bottom + "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = -2e-4\n" +
                     "start = -1e-4",
                 {"scene.toml:11: displacement[3]", "not 0 at time 0"});
  expect_refusal("[[periodic]]\nsides = ['left', 'right']\njump_y = { value = 0.0, start = 1e-4 }",
                 {"scene.toml:2: periodic[1]", "not 0 at time 0"});
}

TEST(conditions, a_component_prescribed_twice_is_refused) {
  expect_refusal(held_bottom + held("bottom", "x"),
                 {"scene.toml:12", "bottom_x once more", "scene.toml:3"});
  expect_refusal(held_bottom + "[[displacement]]\non = 'left'\ncomponent = 'x'\nvalue = 1.0",
                 {"scene.toml:11: displacement[3]", "component x of node 1",
                  "prescribed otherwise by scene.toml:3: displacement[1]"});
  // The corner of two sides that say the same is no contradiction.
  EXPECT_NO_THROW(read_model(held_bottom + held("left", "x")));
}

TEST(conditions, sines_that_end_at_other_times_contradict_each_other) {
  const auto on = [](const std::string& set, const std::string& periods) {
    return "[[displacement]]\non = '" + set +
           "'\ncomponent = 'x'\nsine = { amplitude = 1e-3, period = 0.1" + periods + " }\n";
  };
  expect_refusal(on("left", ", periods = 2") + on("bottom", "") + held("bottom", "y"),
                 {"component x of node 1"});
}

TEST(conditions, a_tie_that_is_prescribed_or_tied_again_is_refused) {
  expect_refusal(held_bottom + "[[tie]]\non = 'bottom'\ncomponent = 'y'",
                 {"scene.toml:11: tie[1]", "both bound and prescribed by scene.toml:7"});
  expect_refusal(held_bottom + "[[tie]]\non = 'left'\ncomponent = 'y'",
                 {"node 1", "expected one of them"});
  expect_refusal(held_bottom + "[[tie]]\non = 'top'\ncomponent = 'y'\n[[platen]]\non = 'top'",
                 {"scene.toml:14: platen[1]", "bound by scene.toml:11: tie[1] already"});
  expect_refusal(held_bottom +
                     "[[platen]]\non = 'top'\n[[displacement]]\non = 'top_left'\n"
                     "component = 'y'\nvalue = 0.1\n[[displacement]]\non = 'top_right'\n"
                     "component = 'y'\nvalue = 0.2",
                 {"platen[1]", "bound to move otherwise"});
}

TEST(conditions, periodic_sides_prescribed_on_one_side_are_refused) {
  expect_refusal(periodic_sides + held("left", "x"),
                 {"scene.toml:2: periodic[1]", "prescribed on one side by scene.toml:4"});
  expect_refusal(held_bottom + periodic_sides + "jump_x = { value = 0.1 }",
                 {"periodic[1]", "bound to differ otherwise", "a jump that agrees"});
  expect_refusal(periodic_sides + "[[tie]]\non = 'top'\ncomponent = 'x'\n" + "", {"holds"});
  expect_refusal("[[periodic]]\nsides = ['left', 'top']",
                 {"periodic[1].sides", "without a partner"});
  expect_refusal("[[periodic]]\nsides = ['left', 'lid']", {"\"lid\"", "bottom_left"});
  expect_refusal("[[periodic]]\nsides = ['left', 'bottom_left']", {"3 and 1 nodes"});
}

TEST(conditions, a_resultant_needs_a_side_that_is_bound_and_free) {
  const std::string resultant = "[[resultant]]\non = 'top'\ncomponent = 'y'\nvalue = 1.0\n";
  expect_refusal(held_bottom + resultant,
                 {"scene.toml:12: resultant[1].on", "each for themselves"});
  expect_refusal(held_bottom +
                     "[[platen]]\non = 'top'\n[[displacement]]\non = 'top'\ncomponent = 'y'\n"
                     "value = 1.0\n" +
                     resultant,
                 {"top_y, which is prescribed by"});
  expect_refusal(held_bottom + "[[platen]]\non = 'top'\n" + resultant + resultant, {"once more"});
}

TEST(conditions, a_rigid_motion_that_is_left_is_named) {
  expect_refusal("", {"3 independent rigid motions"});
  expect_refusal("[[displacement]]\non = 'bottom'\ncomponent = 'y'\nvalue = 0.0",
                 {"translation along x"});
  expect_refusal(
      "[[displacement]]\non = 'bottom_right'\ncomponent = 'y'\nvalue = 0.0\n"
      "[[displacement]]\non = 'bottom_right'\ncomponent = 'x'\nvalue = 0.0",
      {"rotation about (2, 0)"});
  expect_refusal(periodic_sides, {"2 independent rigid motions"});
  EXPECT_NO_THROW(read_model(held_bottom));
}

TEST(conditions, a_platen_needs_a_straight_side) {
  const toml::table content = toml::parse("[[platen]]\non = 'top'").table();
  SceneTable scene(content, "scene.toml", "");
  Model model;
  model.mesh = box_mesh({1, 1}, {2, 2}, ElementKind::q4);
  model.mesh.nodes.back().y() += 0.01;
  EXPECT_THROW(read_conditions(scene, 1, model), InputError);
}

std::string shape_refusal(ElementKind kind, std::size_t node, const Eigen::Vector2d& shift) {
  Mesh mesh = box_mesh({2, 1}, {2, 1}, kind);
  EXPECT_NO_THROW(check_shapes(mesh, "mesh"));
  mesh.nodes[node] += shift;
  try {
    check_shapes(mesh, "scene.toml:1: mesh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(conditions, badly_shaped_elements_are_refused_by_number) {
  for (const auto kind : {ElementKind::q4, ElementKind::q4r, ElementKind::t3}) {
    EXPECT_NE(shape_refusal(kind, 2, {-1.7, 0}).find("scene.toml:1: mesh: element "),
              std::string::npos);
    EXPECT_EQ(shape_refusal(kind, 2, {0.3, 0.1}), "nothing was refused");
  }
  EXPECT_NE(shape_refusal(ElementKind::t3, 0, {3, 0}).find("element 1 (t3"), std::string::npos);
  EXPECT_NE(shape_refusal(ElementKind::t3, 0, {3, 0}).find("an inverted"), std::string::npos);
  EXPECT_NE(shape_refusal(ElementKind::q4, 2, {-0.6, 0.7}).find("element 2"), std::string::npos);
  // A mid-side node beyond the quarter of its side.
  EXPECT_NE(shape_refusal(ElementKind::q8, 1, {0.28, 0}).find("element 1 (q8"), std::string::npos);
  EXPECT_EQ(shape_refusal(ElementKind::q8, 1, {0.1, 0}), "nothing was refused");
}

}  // namespace
}  // namespace verification
