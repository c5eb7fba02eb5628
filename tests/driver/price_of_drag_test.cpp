// The difference that drag makes along a path, told beside the same path in equilibrium.
#include "point/price_of_drag.hpp"

#include "app/material.hpp"

#include <gtest/gtest.h>

namespace verification {
namespace {

CsvTable path_of(double factor, double volume) {
  CsvTable table;
  table.names = {"step", "volumetric_strain", "sigma11", "sigma12", "sigma21", "sigma22"};
  table.columns = {{0, 1, 2}, {0, 0.001, volume}, {-1e5, -1e5, -1e5},
                   {0, 0, 0}, {0, 0, 0},          {-1e5, -1.5e5, -1e5 - factor * 1e5}};
  return table;
}

TEST(price_of_drag, is_told_by_stress_and_volume) {
  // Deviators of 50 and 102 kPa beside 50 and 100.
  const std::string text = price_of_drag(path_of(1.02, 0.012), path_of(1, 0.01));
  EXPECT_NE(text.find("over 2 steps: stress deviator +1.33 % in the mean, 2.00 % of its largest "
                      "value at most (step 2)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("volumetric strain 1.200 % at the end, 1.000 % in equilibrium"),
            std::string::npos)
      << text;
}

TEST(price_of_drag, needs_a_step) {
  CsvTable none = path_of(1, 0);
  for (auto& column : none.columns) column.resize(1);
  EXPECT_NE(price_of_drag(path_of(1, 0), none).find("no step"), std::string::npos);
}

TEST(price_of_drag, leaves_out_the_law_in_time_alone) {
  PointScene scene;
  scene.name = "sand";
  change(scene.material, "solver", "viscous_number", 1e-3);
  change(scene.material, "solver", "viscous_steps", 2L);
  change(scene.material, "solver", "tolerance", 1e-9);
  const PointScene balanced = in_equilibrium(scene);
  EXPECT_EQ(balanced.name, "sand_equilibrium");
  EXPECT_TRUE(has_drag(scene.material));
  EXPECT_FALSE(has_drag(balanced.material));
  EXPECT_EQ(balanced.material.changes["solver"]["tolerance"].value_or(0.0), 1e-9);
  EXPECT_FALSE(balanced.material.changes["solver"].as_table()->contains("viscous_steps"));
}

}  // namespace
}  // namespace verification
