// The scenes of guo2014_multiscale: they read, and the meshes of one test differ in their mesh alone.
#include "../data.hpp"
#include "fe/scene.hpp"
#include "point/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {
namespace {

const std::filesystem::path directory =
    grainlaw::test::data_file("../../verification/scenes/guo2014_multiscale");

FiniteElementScene scene(const std::string& name) {
  return read_fe_scene(SceneFile(directory / (name + ".toml")));
}

TEST(guo2014_multiscale, every_scene_reads) {
  int meshes = 0, points = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".toml" || name.starts_with("pack_")) continue;
    const SceneFile file(entry.path());
    if (name.starts_with("rve")) {
      EXPECT_NO_THROW(read_point_scenes(file)) << entry.path();
      ++points;
    } else {
      EXPECT_NO_THROW(read_fe_scene(file)) << entry.path();
      ++meshes;
    }
  }
  EXPECT_GE(meshes, 20);
  EXPECT_EQ(points, 5);
}

TEST(guo2014_multiscale, meshes_of_one_test_are_loaded_alike) {
  for (const char* name : {"biaxial_6x10", "biaxial_6x10_fbar", "biaxial_10x15", "biaxial_12x20",
                           "biaxial_12x20_fbar", "biaxial_6x10_q8"}) {
    const FiniteElementScene mesh = scene(name);
    const FiniteElementScene small = scene("biaxial_2x4");
    EXPECT_EQ(mesh.steps, small.steps) << name;
    EXPECT_EQ(mesh.solver.newton.tolerance, small.solver.newton.tolerance) << name;
    ASSERT_EQ(mesh.model.displacements.size(), small.model.displacements.size()) << name;
    for (std::size_t k = 0; k < small.model.displacements.size(); ++k)
      EXPECT_EQ(mesh.model.displacements[k].value.at(1), small.model.displacements[k].value.at(1))
          << name;
  }
}

TEST(guo2014_multiscale, cyclic_tests_turn_at_the_same_stress_and_strain) {
  for (const char* control : {"cyclic_strain_", "cyclic_stress_"}) {
    const FiniteElementScene column = scene(std::string(control) + "column");
    const FiniteElementScene mesh = scene(std::string(control) + "15x10");
    ASSERT_TRUE(column.cycle && mesh.cycle);
    EXPECT_DOUBLE_EQ(column.cycle->limit_displacement, mesh.cycle->limit_displacement);
    EXPECT_DOUBLE_EQ(2 * column.cycle->limit_force, mesh.cycle->limit_force);  // half as wide
    EXPECT_DOUBLE_EQ(column.cycle->end_mean_stress, mesh.cycle->end_mean_stress);
    EXPECT_DOUBLE_EQ(column.cycle->end_displacement, mesh.cycle->end_displacement);
  }
}

}  // namespace
}  // namespace verification
