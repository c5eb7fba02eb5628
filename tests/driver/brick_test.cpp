// Bricks with spheres in their integration points: forces, agreement with one volume, and mistakes that
// are told.
#include "app/csv.hpp"
#include "brick/newton.hpp"
#include "brick/run.hpp"
#include "brick/scene.hpp"
#include "point/driver.hpp"
#include "sphere_lattice.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace verification {
namespace {

constexpr double lateral = 7e5;  // [Pa], near the stress of the lattice
const std::string box = "[mesh]\nsize = [1.0, 1.0, 1.0]\ndivisions = [1, 1, 1]\n";

std::string moved(const std::string& set, const std::string& component, double value) {
  return "[[displacement]]\non = '" + set + "'\ncomponent = '" + component +
         "'\nvalue = " + std::to_string(value) + "\n";
}
const std::string rollers =
    moved("left", "x", 0) + moved("front", "y", 0) + moved("bottom", "z", 0);
const std::string drained = rollers + moved("top", "z", -3e-3) + R"(
[[tie]]
on = 'right'
component = 'x'
[[tie]]
on = 'back'
component = 'y'
[[pressure]]
on = 'right'
value = 7e5
[[pressure]]
on = 'back'
value = 7e5
)";

class brick : public testing::Test {
 protected:
  brick() { write_sphere_lattice(directory_); }

  SceneFile scene(const std::string& head, const std::string& tables) {
    std::ofstream(directory_ / "scene.toml") << head << sphere_lattice << tables;
    return SceneFile(directory_ / "scene.toml");
  }

  void expect_told(const std::string& head, const std::string& tables, const std::string& told) {
    try {
      read_brick_scene(scene(head, tables));
      ADD_FAILURE() << "nothing was told, expected " << told;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
    }
  }

  void expect_one_volume(const std::string& solver) {
    const BrickScene read = read_brick_scene(scene("steps = 3\n", solver + box + drained));
    const Material material = make_material(read.material, 3);
    BrickNewton body(read.model, material, read.newton, 1);
    body.advance(0, 0, {});
    PointDriverOf<3> point(material, {});
    point.run(triaxial_segment(0, -lateral, 1), {});
    for (int step = 1; step <= 3; ++step) {
      const BrickStep made = body.advance(step / 3.0, step, {});
      point.run(triaxial_segment(-1e-3, -lateral, 1), {});
      EXPECT_LE(made.record.effort.iterations, 5) << step;
      EXPECT_LE(made.residuals.back(), 1e-8) << step;
      const RecordOf<3>& expected = point.record();
      EXPECT_LT((made.record.cauchy - expected.cauchy).norm(), 1e-6 * expected.cauchy.norm());
      EXPECT_LT((made.record.deformation - expected.deformation).norm(), 1e-9);
    }
    for (std::size_t p = 1; p < 8; ++p)
      EXPECT_LT((deformation_gradient<3>(body.field().state(p)) -
                 deformation_gradient<3>(body.field().state(0)))
                    .norm(),
                1e-12);
  }

  grainlaw::test::TemporaryDirectory directory_;
};

TEST(brick_mesh, points_fill_the_box_and_gradients_carry_a_linear_field) {
  const BrickMesh mesh = make_box({2, 3, 4}, {2, 1, 3});
  Eigen::Matrix3d linear;
  linear << 1, 2, 3, -4, 5, 6, 7, -8, 9;
  double volume = 0;
  for (const auto& element : mesh.elements)
    for (const BrickPoint& point : brick_points(mesh, element)) {
      volume += point.volume;
      Eigen::Matrix3d found = Eigen::Matrix3d::Zero();
      for (int a = 0; a < 8; ++a)
        found += linear *
                 mesh.nodes[static_cast<std::size_t>(element[static_cast<std::size_t>(a)])] *
                 point.gradient.row(a);
      EXPECT_LT((found - linear).norm(), 1e-12);
    }
  EXPECT_NEAR(volume, 24, 1e-12);
}

TEST(brick_mesh, pressure_pushes_inwards_with_the_area_of_each_side_and_balances) {
  const BrickMesh mesh = make_box({2, 3, 4}, {1, 2, 1});
  const std::map<std::string, Eigen::Vector3d> expected{
      {"left", {12, 0, 0}}, {"right", {-12, 0, 0}}, {"front", {0, 8, 0}},
      {"back", {0, -8, 0}}, {"bottom", {0, 0, 6}},  {"top", {0, 0, -6}}};
  for (const auto& [name, force] : expected) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& face : mesh.faces.at(name)) {
      std::array<Eigen::Vector3d, 4> positions;
      for (std::size_t a = 0; a < 4; ++a)
        positions[a] = mesh.nodes[static_cast<std::size_t>(face[a])];
      for (int a = 0; a < 4; ++a) sum += face_pressure(positions).force.segment<3>(3 * a);
    }
    EXPECT_LT((sum - force).norm(), 1e-12) << name;
  }
}

TEST(brick_mesh, stiffness_of_a_pressure_matches_central_differences) {
  const std::array<Eigen::Vector3d, 4> positions{
      Eigen::Vector3d{0, 0.1, 0}, {1.1, 0, 0.2}, {0, 0.9, -0.1}, {1, 1.2, 0.3}};
  const FacePressure exact = face_pressure(positions);
  constexpr double h = 1e-6;
  for (int b = 0; b < 12; ++b) {
    std::array<Eigen::Vector3d, 4> up = positions, down = positions;
    up[static_cast<std::size_t>(b / 3)](b % 3) += h;
    down[static_cast<std::size_t>(b / 3)](b % 3) -= h;
    const Eigen::Matrix<double, 12, 1> difference =
        (face_pressure(up).force - face_pressure(down).force) / (2 * h);
    EXPECT_LT((difference - exact.derivative.col(b)).norm(), 1e-9) << b;
  }
}

TEST_F(brick, under_triaxial_compression_is_one_volume) { expect_one_volume(""); }

// The points of both are told the same time.
TEST_F(brick, with_drag_is_one_volume) {
  expect_one_volume("solver = { viscous_number = 1e-3, viscous_rate = 1e-3 }\n");
}

TEST_F(brick, several_are_as_one) {
  const auto end = [&](const std::string& mesh) {
    const BrickScene read = read_brick_scene(scene("steps = 1\n", mesh + drained));
    BrickNewton body(read.model, make_material(read.material, 3), read.newton, 1);
    body.advance(0, 0, {});
    return body.advance(1, 1, {}).record.cauchy;
  };
  const TensorOf<3> one = end(box);
  const TensorOf<3> several = end("[mesh]\nsize = [1.0, 1.0, 1.0]\ndivisions = [1, 2, 1]\n");
  EXPECT_LT((several - one).norm(), 1e-6 * one.norm());
}

TEST_F(brick, run_writes_its_table_and_stops_where_it_is_asked_to) {
  run_brick_scene(scene("steps = 3\nname = 'run'\n", box + drained), {directory_.string()}, 1);
  const CsvTable table = read_csv(directory_ / "run.csv");
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_NEAR(table["axial_strain"][1], 1e-3, 1e-9);
  EXPECT_NEAR(table["lateral_stress"][1], lateral, 1e-5 * lateral);
  // The side that is led carries the axial stress, on an area that the lateral ties move.
  const CsvTable forces = read_csv(directory_ / "run_force.csv");
  ASSERT_EQ(forces.rows(), 2U);
  EXPECT_NEAR(forces["top_z_displacement"][1], -1e-3, 1e-12);
  const double area =
      (1 + forces["right_x_displacement"][1]) * (1 + forces["back_y_displacement"][1]);
  EXPECT_NEAR(forces["top_z_force"][1], -table["axial_stress"][1] * area, 1e-6 * lateral);
  EXPECT_NEAR(forces["top_z_force"][1], -forces["bottom_z_force"][1], 1e-6 * lateral);
  EXPECT_NEAR(forces["right_x_force"][1], 0, 1e-6 * lateral);
}

TEST_F(brick, mistakes_of_scenes_are_told) {
  const std::string steps = "steps = 1\n";
  expect_told(steps, "[mesh]\nsize = [1.0, 1.0]\ndivisions = [1, 1, 1]\n",
              "mesh.size: found [ 1.0, 1.0 ], expected 3 numbers");
  expect_told(steps, "[mesh]\nsize = [1.0, 1.0, 1.0]\ndivisions = [1, 1.5, 1]\n",
              "mesh.divisions: found 1.5, expected an integer");
  expect_told(steps, "[mesh]\nsize = [1.0, 1.0, 1.0]\ndivisions = [1, 1, 1]\nelement = 'q4'\n",
              "mesh.element: found \"q4\", expected one of hex8");
  expect_told(steps, box + moved("above", "z", 0), "on: found \"above\", expected one of back");
  expect_told(steps, box + moved("top", "w", 0), "component: found \"w\", expected one of x, y, z");
  expect_told(steps, box + rollers + "[[tie]]\non = 'bottom'\ncomponent = 'z'\n",
              "on: found nodes whose displacement is prescribed or tied already");
  expect_told(steps, box + moved("left", "x", 0),
              "displacement: found nothing that holds 3 independent rigid motions");
  expect_told(steps, box + rollers + moved("front", "y", 1), "value: found 1, expected 0");
  expect_told(steps + "solver = 'relaxation'\n", box + rollers, "solver: found \"relaxation\"");
  expect_told(steps, box + rollers + "[cycle]\non = 'top'\n", "cycle");
}

TEST_F(brick, is_held_when_its_conditions_leave_no_rigid_motion) {
  const auto tied = [](const std::string& set, const std::string& component) {
    return "[[tie]]\non = '" + set + "'\ncomponent = '" + component + "'\n";
  };
  const auto on = [](const std::string& set, const std::string& components) {
    std::string all;
    for (const char component : components) all += moved(set, std::string(1, component), 0);
    return all;
  };
  const std::string clamped = on("bottom", "xyz");
  EXPECT_NO_THROW(read_brick_scene(scene("steps = 1\n", box + clamped)));
  EXPECT_NO_THROW(read_brick_scene(scene("steps = 1\n", box + on("right", "y") + on("top", "xz"))));
  const auto expect_free = [&](const std::string& conditions, const std::string& motion) {
    expect_told("steps = 1\n", box + conditions,
                "found nothing that holds " + motion + ", expected");
  };
  expect_free(on("left", "x") + on("front", "y"), "translation along z");
  expect_free(on("bottom", "z") + tied("left", "x") + tied("front", "y"),
              "2 independent rigid motions");
  expect_free(on("left", "z") + on("bottom", "x") + on("front", "y"),
              "rotation about an axis along y");
  expect_free(on("bottom", "z"), "3 independent rigid motions");
  expect_free("", "6 independent rigid motions");
}

}  // namespace
}  // namespace verification
