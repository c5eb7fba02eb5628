// Representative volumes of spheres along paths of scenes: stresses that are reached, volumes that are
// kept, and mistakes that are told.
#include "app/csv.hpp"
#include "point/driver.hpp"
#include "point/run.hpp"
#include "point/scene.hpp"
#include "point/start.hpp"
#include "sphere_lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace verification {
namespace {

class sphere_path : public testing::Test {
 protected:
  sphere_path() { write_sphere_lattice(directory_); }

  PointScene read(const std::string& segments, const std::string& material = sphere_lattice) {
    std::ofstream(directory_ / "scene.toml") << material << segments;
    return read_point_scenes(SceneFile(directory_ / "scene.toml")).front();
  }

  // The driver at the end of the path.
  PointDriverOf<3> lead(const std::string& segments, const PointObserverOf<3>& observe = {}) {
    const PointScene scene = read(segments);
    PointDriverOf<3> driver(make_material(scene.material, 3), scene.options);
    for (const Segment& segment : scene.segments) driver.run(segment, observe);
    return driver;
  }

  void expect_told(const std::string& segments, const std::string& told,
                   const std::string& material = sphere_lattice) {
    try {
      const PointScene scene = read(segments, material);
      make_material(scene.material, scene.dimension);
      ADD_FAILURE() << "nothing was told of " << segments;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
    }
  }

  grainlaw::test::TemporaryDirectory directory_;
};

TEST_F(sphere_path, triaxial_compression_ends_under_its_lateral_stress) {
  const PointScene scene = read("[[segment]]\nsteps = 1\nF33 = 1.0\n");
  PointDriverOf<3> driver(make_material(scene.material, 3), {});
  const double pressure = driver.record().mean_pressure();
  EXPECT_GT(pressure, 1e5);
  driver.run(triaxial_segment(-3e-3, -pressure, 3), [](const PointStepOf<3>& step) {
    EXPECT_EQ(step.record.effort.cuts, 0);
    EXPECT_LE(step.record.effort.iterations, 5);
  });
  const RecordOf<3>& end = driver.record();
  EXPECT_EQ(end.step, 3);
  EXPECT_NEAR(end.cauchy(0, 0), -pressure, 1e-7 * pressure);
  EXPECT_NEAR(end.cauchy(1, 1), -pressure, 1e-7 * pressure);
  EXPECT_GT(end.axial_stress(), 1.2 * pressure);
  EXPECT_NEAR(end.axial_strain(), 3e-3, 1e-15);
  EXPECT_NEAR(end.mean_pressure(), (end.axial_stress() + 2 * pressure) / 3, 1e-7 * pressure);
  EXPECT_NEAR(end.deviatoric_stress(), end.axial_stress() - pressure, 1e-7 * pressure);
}

TEST_F(sphere_path, deviatoric_stress_is_below_zero_in_extension) {
  const PointScene scene = read("[[segment]]\nsteps = 1\nF33 = 1.0\n");
  PointDriverOf<3> driver(make_material(scene.material, 3), {});
  const double pressure = driver.record().mean_pressure();
  driver.run(triaxial_segment(1e-3, -pressure, 1), {});
  const RecordOf<3>& end = driver.record();
  EXPECT_LT(end.axial_stress(), 0.99 * pressure);
  EXPECT_NEAR(end.deviatoric_stress(), end.axial_stress() - pressure, 1e-7 * pressure);
}

TEST_F(sphere_path, isochoric_compression_keeps_the_volume_to_rounding) {
  const auto observe = [](const PointStepOf<3>& step) {
    const TensorOf<3>& F = step.record.deformation;
    EXPECT_NEAR(F.determinant(), 1, 1e-14);
    EXPECT_EQ(F(0, 0), F(1, 1));
  };
  const PointDriverOf<3> driver =
      lead("[[segment]]\nsteps = 3\nF33 = 0.997\nisochoric = true\n", observe);
  EXPECT_EQ(driver.record().step, 3);
  EXPECT_EQ(driver.record().deformation(2, 2), 0.997);
  EXPECT_GT(driver.record().axial_stress(), driver.record().lateral_stress());
}

TEST_F(sphere_path, isochoric_compression_of_two_axes_leaves_the_third_to_follow) {
  const PointDriverOf<3> driver =
      lead("[[segment]]\nsteps = 2\nF33 = 0.998\ndF11 = 5e-4\nF12 = 1e-3\nisochoric = true\n");
  const TensorOf<3>& F = driver.record().deformation;
  EXPECT_NEAR(F.determinant(), 1, 1e-14);
  EXPECT_NEAR(F(0, 0), 1.0005, 1e-15);
  EXPECT_NEAR(F(1, 1), 1 / (1.0005 * 0.998), 1e-14);
}

TEST_F(sphere_path, true_triaxial_stresses_and_free_shears_of_either_measure_are_reached) {
  const PointDriverOf<3> driver = lead(R"(
[[segment]]
steps = 3
F33 = 0.998
sigma11 = -120e3
P22 = -200e3
sigma12 = 2e3
P13 = 0.0
sigma23 = 0.0
)");
  const RecordOf<3>& end = driver.record();
  EXPECT_NEAR(end.cauchy(0, 0), -120e3, 1);
  EXPECT_NEAR(end.stress(1, 1), -200e3, 1);
  EXPECT_NEAR(end.cauchy(0, 1), 2e3, 1);
  EXPECT_NEAR(end.stress(0, 2), 0, 1);
  EXPECT_NEAR(end.cauchy(1, 2), 0, 1);
  EXPECT_EQ(end.deformation(1, 0), 0);
  EXPECT_NE(end.deformation(0, 1), 0);
}

TEST_F(sphere_path, simple_shear_moves_its_component_alone_and_turns_the_spheres) {
  const PointDriverOf<3> driver = lead("[[segment]]\nsteps = 2\nF13 = 2e-3\n");
  TensorOf<3> expected = TensorOf<3>::Identity();
  expected(0, 2) = 2e-3;
  EXPECT_EQ(driver.record().deformation, expected);
  EXPECT_GT(driver.record().cauchy(0, 2), 0);
  EXPECT_GT(driver.record().mean_rotation, 0);
}

// det F of the plane's scenes is kept by the same key.
TEST_F(sphere_path, isochoric_is_of_discs_too) {
  const PointScene scene = read("[[segment]]\nsteps = 2\nF22 = 0.99\nisochoric = true\n", R"(
[material]
dimension = 2
thickness = 0.1
packing = { generator = "hexagonal", columns = 2, rows = 2, radius = 5e-3, pressure = 1e5 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5463 }
)");
  PointDriver driver(make_material(scene.material), scene.options);
  driver.run(scene.segments.front(), {});
  EXPECT_NEAR(driver.record().deformation(0, 0), 1 / 0.99, 1e-14);
}

TEST_F(sphere_path, run_writes_a_table_of_three_dimensions) {
  const PointScene scene = read("[[segment]]\nsteps = 1\nF33 = 0.999\n",
                                "figure = false\nparticle_measures = true\n" + sphere_lattice);
  PointEnd end;
  run_point(scene, directory_ / "run", end);
  EXPECT_EQ(end.text, "done");
  EXPECT_EQ(end.particles, 32);
  EXPECT_EQ(end.deformation(2, 2), 0.999);
  const CsvTable table = read_csv(directory_ / "run.csv");
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_NEAR(table["mean_pressure"][1],
              -(table["sigma11"][1] + table["sigma22"][1] + table["sigma33"][1]) / 3, 1e-5);
  EXPECT_NEAR(table["fabric11"][1] + table["fabric22"][1] + table["fabric33"][1], 1, 1e-10);
  EXPECT_NEAR(table["axial_strain"][1], 1e-3, 1e-12);
  EXPECT_GT(read_csv(directory_ / "run_particles.csv")["normalised_overlap"][0], 1e-3);
}

TEST_F(sphere_path, mistakes_of_scenes_are_told) {
  const std::string axial = "[[segment]]\nsteps = 1\nF33 = 0.999\n";
  expect_told(axial + "P33 = -1e5\n",
              "segment[1].P33: found a second condition beside F33, expected one condition");
  expect_told("[[segment]]\nsteps = 1\nF44 = 0.999\n", "F44");
  expect_told("[[segment]]\nsteps = 1\nF33 = 0.001\n", "F33: found 0.001, expected a stretch");
  expect_told("[[segment]]\nsteps = 1\nsigma33 = 1e5\n", "sigma33: found 100000, which is tension");
  expect_told("[[segment]]\nsteps = 1\nF11 = 1.0\nF22 = 1.0\nF33 = 1.0\nisochoric = true\n",
              "isochoric: found true, and all of the diagonal of F has a condition");
  expect_told(axial, "thickness: found a number, expected none with dimension = 3",
              sphere_lattice + "thickness = 0.1\n");
  expect_told(axial, "F33: found a component of three dimensions, expected one of 11, 12, 21, 22",
              "[material]\ndimension = 2\n");
  expect_told("[[segment]]\nsteps = 1\nF22 = 0.999\n",
              "abscissa: found \"F13\", expected one of axial_strain, F12",
              "abscissa = 'F13'\nmaterial.dimension = 2\n");
}

TEST_F(sphere_path, commands_of_the_plane_refuse_spheres) {
  const PointScene scene = read("[[segment]]\nsteps = 1\nF33 = 1.0\n");
  try {
    make_material(scene.material);
    ADD_FAILURE() << "nothing was told";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("dimension: found 3, expected 2"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace verification
