// A biaxial test past its peak in small: the whole way from the scene file to the tables.
#include "../temporary_directory.hpp"
#include "app/csv.hpp"
#include "fe/run.hpp"
#include "scene_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <string>

namespace verification {
namespace {

using grainlaw::test::TemporaryDirectory;

class biaxial_scene : public testing::Test {
 protected:
  // 1 x 2 elements between smooth platens, membranes under 100 kPa, in steps of 0.1 % axial strain, with
  // drag on the fluctuations.
  void run(int steps, const std::string& more) {
    const auto path = directory_.path() / "biaxial.toml";
    const double way = 1e-4 * steps;
    std::ofstream(path) << "steps = " << steps << "\nthreads = 1\n"
                        << more
                        << small_packing_of_seed(5, ", viscous_number = 1e-3, viscous_rate = 1e-3")
                        << R"(
[newton]
tolerance = 1e-6
max_cuts = 6

[mesh]
size = [0.05, 0.1]
divisions = [1, 2]
)" << held("bottom", "y")
                        << held("bottom_left", "x") << R"(
[[displacement]]
on = "top"
component = "y"
value = )" << -way << R"(

[[pressure]]
on = "left"
value = 100e3

[[pressure]]
on = "right"
value = 100e3
)";
    run_fe_scene(SceneFile(path), {{directory_.path().string()}, false, {}, {}});
  }
  [[nodiscard]] CsvTable table(const std::string& end) const {
    return read_csv(directory_.path() / ("biaxial" + end + ".csv"));
  }

  TemporaryDirectory directory_;
};

TEST_F(biaxial_scene, reaches_the_end_past_its_peak) {
  run(30, "every_point = [\"mean_stress\", \"stress_ratio\"]\n");
  const CsvTable history = table(""), forces = table("_force"),
                 ratios = table("_every_stress_ratio");
  ASSERT_EQ(history.rows(), 31U);
  EXPECT_NEAR(history["F22"].back(), 0.97, 1e-9);
  const auto& axial = history["sigma22"];
  const auto peak = std::min_element(axial.begin(), axial.end());
  EXPECT_LT(*peak, -170e3);  // a friction of 0.5 bears that; nothing bears ten times the pressure
  EXPECT_GT(*peak, -1e6);
  EXPECT_LT(peak - axial.begin(), 30);  // and not the last step
  for (std::size_t k = 0; k < history.rows(); ++k) {
    EXPECT_NEAR(history["sigma11"][k], -100e3, 0.02 * 100e3) << k;  // the membranes'
    EXPECT_NEAR(forces["top_y_force"][k], -forces["bottom_y_force"][k], 0.02 * 1e4) << k;
    // Every table has every step, and the points' mean is near the mean's.
    double mean = 0;
    for (std::size_t p = 1; p < ratios.columns.size(); ++p) mean += ratios.columns[p][k] / 8;
    const double of_mean =
        (history["sigma11"][k] - axial[k]) / std::abs(history["sigma11"][k] + axial[k]);
    EXPECT_NEAR(mean, std::abs(of_mean), 0.15) << k;
  }
  EXPECT_EQ(ratios.columns.size(), 1U + 8U);
}

TEST_F(biaxial_scene, balances_every_step_past_its_peak) {
  run(30, "");
  const CsvTable balance = table("_balance");
  ASSERT_EQ(balance.rows(), 31U);
  for (std::size_t k = 0; k < balance.rows(); ++k) {
    EXPECT_LE(balance["residual"][k], 1e-6) << k;
    EXPECT_EQ(balance["loose_parts"][k], 0) << k;
    EXPECT_EQ(balance["jumps_crossed"][k], 0) << k;
    EXPECT_EQ(balance["history_advanced"][k], 0) << k;
    EXPECT_LE(balance["last_iterations"][k], balance["iterations"][k]) << k;
  }
}

TEST_F(biaxial_scene, before_the_peak_takes_at_most_five_iterations_a_step) {
  run(5, "");
  const CsvTable history = table("");
  for (std::size_t k = 1; k < history.rows(); ++k) {
    EXPECT_LE(history["newton_iterations"][k], 5) << k;
    EXPECT_EQ(history["step_cuts"][k], 0) << k;
    EXPECT_EQ(history["loose_parts"][k], 0) << k;
  }
}

TEST_F(biaxial_scene, with_the_table_of_another_solver_is_refused) {
  try {
    run(1, "solver = \"relaxation\"\n");
    ADD_FAILURE() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("newton: found a table, expected none with solver = "
                        "\"relaxation\""),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace verification
