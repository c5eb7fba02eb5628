// Bodies of spheres: agreement with one volume, what is refused, restart, files.
#include "app/csv.hpp"
#include "fe/run.hpp"
#include "fe/scene.hpp"
#include "point/driver.hpp"
#include "sphere_lattice.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <string>

namespace verification {
namespace {

constexpr double lateral = 7e5;  // [Pa], near the stress of the lattice

std::string box(const std::string& element, const std::string& divisions = "1, 1, 1") {
  return "[mesh]\nsize = [1.0, 1.0, 1.0]\ndivisions = [" + divisions + "]\nelement = '" + element +
         "'\n";
}
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
// Drag, by which the answer depends on what time the points are told.
const std::string drag = "solver = { viscous_number = 1e-3, viscous_rate = 1e-3 }\n";

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class solid : public testing::Test {
 protected:
  solid() { write_sphere_lattice(directory_); }

  SceneFile scene(const std::string& head, const std::string& tables) {
    std::ofstream(directory_ / "scene.toml") << head << sphere_lattice << tables;
    return SceneFile(directory_ / "scene.toml");
  }

  void expect_told(const std::string& head, const std::string& tables, const std::string& told) {
    try {
      read_fe_scene(scene(head, tables));
      ADD_FAILURE() << "nothing was told, expected " << told;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
    }
  }

  void expect_one_volume(const std::string& tables) {
    const FiniteElementScene read = read_fe_scene(scene("steps = 3\n", tables + drained));
    const Material material = make_material(read.material, 3);
    const auto body = make_solver(read.solver, read.model, material, 1);
    body->advance(0, 0);
    PointDriverOf<3> point(material, {});
    point.run(triaxial_segment(0, -lateral, 1), {});
    for (int step = 1; step <= 3; ++step) {
      const LoadStep made = body->advance(step / 3.0, step);
      point.run(triaxial_segment(-1e-3, -lateral, 1), {});
      EXPECT_LE(made.record.effort.iterations, 5) << step;
      EXPECT_LE(made.residuals.back(), 1e-8) << step;
      const RecordOf<3>& expected = point.record();
      EXPECT_LT((made.record.cauchy - expected.cauchy).norm(), 1e-6 * expected.cauchy.norm());
      EXPECT_LT((made.record.deformation - expected.deformation).norm(), 1e-9);
    }
    for (std::size_t p = 1; p < body->points().size(); ++p)
      EXPECT_LT((body->points().deformation(p) - body->points().deformation(0)).norm(), 1e-12);
  }

  // Runs the scene in pieces and at once, and compares all files but times.
  void expect_restart_in_the_same_bytes(const std::string& head, const std::string& tables) {
    const SceneFile file = scene(
        "steps = 3\nthreads = 1\nvtk_every = 1\npackings = [1]\npoints = [2]\nname = 's'\n" + head,
        tables + "[picture]\nfields = ['mean_stress']\n");
    const auto run = [&](const char* name, bool again, std::optional<int> stop) {
      run_fe_scene(file, {{(directory_ / name).string()}, again, {}, stop});
    };
    run("whole", false, {});
    run("pieces", false, 1);
    run("pieces", true, 2);
    run("pieces", true, {});
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(directory_ / "whole")) {
      const auto name = entry.path().filename();
      const auto end = name.extension();
      if (entry.is_directory() || name == "s_cost.csv" || end == ".checkpoint" || end == ".png")
        continue;
      EXPECT_TRUE(contents(entry.path()) == contents(directory_ / "pieces" / name)) << name;
      ++files;
    }
    EXPECT_GE(files, 12);
  }

  grainlaw::test::TemporaryDirectory directory_;
};

class solid_element : public solid, public testing::WithParamInterface<const char*> {};

TEST_P(solid_element, under_triaxial_compression_is_one_volume) {
  expect_one_volume(box(GetParam()));
}

TEST_P(solid_element, several_are_as_one) {
  const auto end = [&](const std::string& mesh) {
    const FiniteElementScene read = read_fe_scene(scene("steps = 1\n", mesh + drained));
    const auto body = make_solver(read.solver, read.model, make_material(read.material, 3), 1);
    body->advance(0, 0);
    return body->advance(1, 1).record.cauchy;
  };
  const auto one = end(box(GetParam()));
  EXPECT_LT((end(box(GetParam(), "1, 2, 1")) - one).norm(), 1e-6 * one.norm());
}

INSTANTIATE_TEST_SUITE_P(elements, solid_element, testing::Values("hex8", "hex8fbar"),
                         [](const auto& entry) { return std::string(entry.param); });

// Held as a body is that only may not move away.
TEST_F(solid, a_pressure_all_around_is_the_cauchy_stress) {
  const double pressure = 7.5e5;
  for (const char* element : {"hex8", "hex8fbar", "hex20", "tet10"}) {
    std::string tables = box(element, "1, 1, 2");
    for (const char* component : {"x", "y", "z"})
      tables += moved("bottom_left_front", component, 0);
    tables += moved("bottom_right_front", "y", 0) + moved("bottom_right_front", "z", 0) +
              moved("bottom_left_back", "z", 0);
    for (const char* side : {"left", "right", "front", "back", "bottom", "top"})
      tables += std::string("[[pressure]]\non = '") + side + "'\nvalue = 7.5e5\n";
    const FiniteElementScene read = read_fe_scene(scene("steps = 1\n", tables));
    const auto body = make_solver(read.solver, read.model, make_material(read.material, 3), 1);
    const BodyRecord record = body->advance(0, 0).record;
    EXPECT_LT((record.cauchy + pressure * Eigen::Matrix3d::Identity()).norm(), 1e-7 * pressure)
        << element;
    EXPECT_GT((record.deformation - Eigen::Matrix3d::Identity()).norm(), 1e-5) << element;
  }
}

// The points of both are told the same time.
TEST_F(solid, with_drag_is_one_volume) { expect_one_volume(drag + box("hex8")); }

TEST_F(solid, restart_ends_in_the_bytes_of_an_uninterrupted_run) {
  expect_restart_in_the_same_bytes("", box("hex8fbar", "1, 1, 2") + drained);
}

TEST_F(solid, restart_of_dynamics_ends_in_the_same_bytes) {
  expect_restart_in_the_same_bytes(
      "solver = 'dynamics'\ndynamics = { duration = 1e-3, density = 2000 }\n",
      box("tet10") + rollers + moved("top", "z", -1e-5));
}

TEST_F(solid, restart_of_relaxation_ends_in_the_same_bytes) {
  expect_restart_in_the_same_bytes("solver = 'relaxation'\n", box("hex8") + drained);
}

TEST_F(solid, run_writes_its_tables_and_stops_where_it_is_asked_to) {
  run_fe_scene(scene("steps = 3\nname = 'run'\n", box("hex8") + drained),
               {{directory_.string()}, false, {}, 1});
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

TEST_F(solid, a_rough_platen_binds_three_components_and_periodic_sides_move_alike) {
  const FiniteElementScene read =
      read_fe_scene(scene("steps = 1\n", box("hex20") + moved("bottom", "x", 0) +
                                             moved("bottom", "y", 0) + moved("bottom", "z", 0) +
                                             "[[periodic]]\nsides = ['left', 'right']\n"
                                             "[[periodic]]\nsides = ['front', 'back']\n"
                                             "[[platen]]\non = 'top'\nsurface = 'rough'\n" +
                                             moved("top", "z", 0) + moved("top", "x", 2e-4)));
  const auto body = make_solver(read.solver, read.model, make_material(read.material, 3), 1);
  body->advance(0, 0);
  const LoadStep step = body->advance(1, 1);
  // Simple shear, which a uniform body takes everywhere.
  EXPECT_NEAR(step.record.deformation(0, 2), 2e-4, 1e-12);
  for (int node = 0; node < static_cast<int>(read.model.mesh.nodes.size()); ++node)
    EXPECT_NEAR(body->displacement()(3 * node), 2e-4 * read.model.mesh.position(node).z(), 1e-9);
}

// Rough platens hold the ends, so that the middle bulges and the specimen bears more.
TEST_F(solid, between_rough_platens_bulges_and_bears_more_than_one_volume) {
  std::string tables;
  for (const char* component : {"x", "y", "z"}) tables += moved("bottom", component, 0);
  tables += moved("top", "x", 0) + moved("top", "y", 0) + moved("top", "z", -4e-3);
  for (const char* side : {"left", "right", "front", "back"})
    tables += std::string("[[pressure]]\non = '") + side + "'\nvalue = 7e5\n";
  for (const char* side : {"left", "right", "back"})
    tables += std::string("[[probe]]\nname = '") + side + "'\non = '" + side + "'\n";
  PointDriverOf<3> one(
      make_material(read_fe_scene(scene("steps = 1\n", drag + box("hex8") + drained)).material, 3),
      {});
  one.run(triaxial_segment(0, -lateral, 1), {});
  one.run(triaxial_segment(-2e-3, -lateral, 2), {});
  for (const std::string element : {"hex8fbar", "hex20"}) {
    run_fe_scene(scene("steps = 2\nname = '" + element + "'\n",
                       drag + "[newton]\ntolerance = 1e-6\n" + box(element, "1, 1, 2") + tables),
                 {{directory_.string()}, false, {}, {}});
    const auto last = [&](const std::string& table, const std::string& column) {
      return read_csv(directory_ / (element + table))[column].back();
    };
    EXPECT_LE(last("_balance.csv", "residual"), 1e-6) << element;
    EXPECT_LE(last("_balance.csv", "iterations"), 6) << element;
    const double force = last("_force.csv", "top_z_force");
    EXPECT_NEAR(force, -last("_force.csv", "bottom_z_force"), 1e-6 * std::abs(force)) << element;
    EXPECT_GT(-force, -1.05 * one.record().cauchy(2, 2)) << element;
    const double out = last("_probes.csv", "right_x");
    EXPECT_GT(out, 1e-6) << element;
    EXPECT_NEAR(last("_probes.csv", "left_x"), -out, 1e-2 * out) << element;
    EXPECT_NEAR(last("_probes.csv", "back_y"), out, 1e-2 * out) << element;
  }
}

TEST_F(solid, mistakes_of_scenes_are_told) {
  const std::string steps = "steps = 1\n", one = box("hex8");
  expect_told(steps, "[mesh]\nsize = [1.0, 1.0]\ndivisions = [1, 1, 1]\n",
              "mesh.size: found [ 1.0, 1.0 ], expected 3 numbers");
  expect_told(steps, box("hex8", "1, 1.5, 1"), "mesh.divisions: found 1.5, expected an integer");
  expect_told(steps, box("q4"), "mesh.element: found \"q4\", expected one of ");
  expect_told(steps, one + moved("above", "z", 0), "on: found \"above\", expected one of back");
  expect_told(steps, one + moved("top", "w", 0), "component: found \"w\", expected one of x, y, z");
  expect_told(steps, one + rollers + "[[tie]]\non = 'bottom'\ncomponent = 'z'\n",
              "both bound and prescribed");
  expect_told(steps, one + moved("left", "x", 0),
              "found nothing that holds 3 independent rigid motions");
  expect_told(steps, one + rollers + moved("front", "y", 1), "front_y once more");
  expect_told(steps, one + rollers + "[[platen]]\non = 'top'\nrotation = 'free'\n",
              "rotation: found \"free\" of a body of spheres");
}

TEST_F(solid, is_held_when_its_conditions_leave_no_rigid_motion) {
  const auto tied = [](const std::string& set, const std::string& component) {
    return "[[tie]]\non = '" + set + "'\ncomponent = '" + component + "'\n";
  };
  const auto on = [](const std::string& set, const std::string& components) {
    std::string all;
    for (const char component : components) all += moved(set, std::string(1, component), 0);
    return all;
  };
  const std::string one = box("hex8");
  EXPECT_NO_THROW(read_fe_scene(scene("steps = 1\n", one + on("bottom", "xyz"))));
  EXPECT_NO_THROW(read_fe_scene(scene("steps = 1\n", one + on("right", "y") + on("top", "xz"))));
  const auto expect_free = [&](const std::string& conditions, const std::string& motion) {
    expect_told("steps = 1\n", one + conditions,
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
