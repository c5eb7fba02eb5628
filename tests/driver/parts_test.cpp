// Steps in parts: what a failure is cut to, and what is told meanwhile and in the end.
#include "app/parts.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace verification {
namespace {

TEST(parts, a_failure_is_cut_and_the_rest_grows_again) {
  std::vector<double> tried, cut;
  const Parts parts = solve_in_parts(
      0, 1, "step 1", 4, false,
      [&](double next, bool) {
        tried.push_back(next);
        return Attempt{.converged = tried.size() > 2, .reason = "no balance"};
      },
      [&](double part, const std::string& reason) {
        cut.push_back(part);
        EXPECT_EQ(reason, "no balance");
      });
  EXPECT_EQ(tried, (std::vector<double>{1, 0.5, 0.25, 0.75, 1}));
  EXPECT_EQ(cut, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(parts.cuts, 2);
  EXPECT_EQ(parts.loose, 0);
}

TEST(parts, a_failure_in_the_smallest_part_says_how_far_the_step_came) {
  try {
    solve_in_parts(0, 2, "step 1", 2, false, [](double next, bool) {
      return Attempt{.converged = next <= 1, .reason = "no balance", .status = GRAINLAW_COLLAPSED};
    });
    ADD_FAILURE() << "nothing was told";
  } catch (const StepError& error) {
    EXPECT_EQ(std::string(error.what()),
              "step 1 failed 50 % along, in parts of 2.5e-01 of it too: no balance");
    EXPECT_EQ(error.status, GRAINLAW_COLLAPSED);
  }
}

TEST(parts, a_step_without_length_is_tried_loose_too_and_its_failure_is_told) {
  std::vector<bool> tried;
  const auto failing = [&](double, bool loose) {
    tried.push_back(loose);
    return Attempt{.reason = "no balance"};
  };
  try {
    solve_in_parts(0, 0, "load step 0", 4, true, failing);
    ADD_FAILURE() << "nothing was told";
  } catch (const ComputationError& error) {
    EXPECT_EQ(std::string(error.what()), "load step 0 failed: no balance");
  }
  EXPECT_EQ(tried, (std::vector<bool>{false, true}));
  const Parts parts = solve_in_parts(
      0, 0, "load step 0", 4, true, [](double, bool loose) { return Attempt{.converged = loose}; });
  EXPECT_EQ(parts.loose, 1);
}

}  // namespace
}  // namespace verification
