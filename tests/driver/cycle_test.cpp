// Cyclic tests: where they turn, how they end, and that they can be taken up again.
#include "fe/solver/cycle.hpp"

#include "fe/conditions/conditions_scene.hpp"
#include "fe/conditions/monitors.hpp"
#include "fe/solver/newton.hpp"
#include "scene_text.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace verification {
namespace {

// Simple shear of one element under constant volume.
class cycle : public testing::Test {
 protected:
  static std::string sides() { return held_bottom + held("top", "y") + periodic_sides; }
  struct Test {
    explicit Test(const std::string& options) {
      const toml::table content = toml::parse("[cycle]\non = 'top'\n" + options + sides()).table();
      SceneTable scene(content, "scene.toml", "");
      // Two rows, so that there is something to solve.
      model.mesh = box_mesh({1, 1}, {1, 2}, ElementKind::q4);
      const Cycle cycle = read_cycle(scene.table("cycle"), model);
      read_conditions(scene, 1, model);
      control.emplace(cycle, model, 1e-3);
      solver = make_newton_solver(model, material, {.tolerance = 1e-10}, 1);
    }
    // All steps, as rows of displacement and force of the top.
    std::vector<std::array<double, 2>> run(int first = 0, int last = 1000) {
      std::vector<std::array<double, 2>> rows;
      run_cycles(
          *control, *solver, last,
          [&](const LoadStep& step, const Solver&) {
            rows.push_back({step.displacements[0], step.reactions[0]});
          },
          first);
      return rows;
    }
    Material material = lattice_material();
    Model model;
    std::optional<CycleControl> control;
    std::unique_ptr<Solver> solver;
  };
};

double largest(const std::vector<std::array<double, 2>>& rows, std::size_t column, double sign) {
  double value = 0;
  for (const auto& row : rows) value = std::max(value, sign * row[column]);
  return value;
}

TEST_F(cycle, displacement_turns_at_its_limit_and_ends_at_zero) {
  Test test("step = 3e-5\nlimit_displacement = 1e-4\ncycles = 2\n");
  const auto rows = test.run();
  EXPECT_TRUE(test.control->finished());
  EXPECT_EQ(test.control->reversals(), 4);
  EXPECT_DOUBLE_EQ(largest(rows, 0, 1), 1e-4);
  EXPECT_DOUBLE_EQ(largest(rows, 0, -1), 1e-4);
  EXPECT_NEAR(rows.back()[0], 0, 1e-15);
  // 4 steps to the limit, 7 there and 7 back and 7 there again, 4 home.
  EXPECT_EQ(rows.size(), 1 + 4 + 7 + 7 + 7 + 4);
}

TEST_F(cycle, steps_that_miss_the_limit_by_rounding_leave_no_empty_one) {
  ASSERT_LT(2.7e-5 + 2.7e-5 + 2.7e-5, 8.1e-5);
  Test test("step = 2.7e-5\nlimit_displacement = 8.1e-5\ncycles = 1\n");
  const auto rows = test.run();
  EXPECT_DOUBLE_EQ(largest(rows, 0, 1), 8.1e-5);
  EXPECT_NEAR(rows.back()[0], 0, 1e-15);
  EXPECT_EQ(rows.size(), 1 + 3 + 6 + 3);
}

TEST_F(cycle, force_turns_at_its_limit_within_the_tolerance) {
  Test test("step = 3e-5\nlimit_force = 5e3\ntolerance = 0.002\ncycles = 2\n");
  const auto rows = test.run();
  EXPECT_TRUE(test.control->finished());
  EXPECT_EQ(test.control->reversals(), 4);
  for (const double sign : {1.0, -1.0}) {
    EXPECT_LE(largest(rows, 1, sign), 5e3 * 1.002);
    EXPECT_GE(largest(rows, 1, sign), 5e3 * 0.998);
  }
}

TEST_F(cycle, a_large_displacement_ends_the_test) {
  Test test("step = 3e-5\nlimit_force = 5e3\nend_displacement = 5e-5\ncycles = 20\n");
  const auto rows = test.run();
  EXPECT_TRUE(test.control->finished());
  EXPECT_LE(rows.size(), 3U);
}

TEST_F(cycle, a_low_mean_stress_ends_the_test) {
  const std::string options = "step = 3e-5\nlimit_displacement = 1e-4\ncycles = 1\n";
  EXPECT_EQ(Test(options + "end_mean_stress = 1.0\n").run().size(), Test(options).run().size());
  EXPECT_EQ(Test(options + "end_mean_stress = 1e9\n").run().size(), 2U);
}

TEST_F(cycle, a_saved_test_goes_on_to_the_same_bits) {
  const std::string options = "step = 3e-5\nlimit_force = 5e3\ncycles = 1\n";
  const auto whole = Test(options).run();
  ASSERT_GT(whole.size(), 6U);
  Test first(options);
  first.run(0, 4);
  CheckpointWriter out;
  first.solver->save(out);
  first.control->save(out);
  Test second(options);
  CheckpointReader in(out.bytes(), "saved");
  second.solver->restore(in);
  second.control->restore(in);
  const auto rest = second.run(5);
  ASSERT_EQ(rest.size() + 5, whole.size());
  for (std::size_t k = 0; k < rest.size(); ++k) EXPECT_EQ(rest[k], whole[k + 5]);
}

TEST_F(cycle, wrong_tests_are_refused) {
  EXPECT_THROW(Test("step = 3e-5\ncycles = 1\n"), InputError);
  EXPECT_THROW(Test("step = 0.0\nlimit_force = 1.0\ncycles = 1\n"), InputError);
  EXPECT_THROW(Test("component = 'y'\nstep = 1e-5\nlimit_force = 1.0\ncycles = 1\n"), InputError);
}

}  // namespace
}  // namespace verification
