// A call in which any one allocation fails asks for a cut with a stiffness that the solver can go
// on with; the same call again gives what it would have given.
#include "../../point/test/failing_allocation.hpp"

#include <grainlaw/calculix.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace grainlaw::test {
namespace {

grainlaw_calculix_material material{"IDLE", "/idle.toml", nullptr};

struct Outcome {
  std::vector<std::array<double, 6>> stresses;
  int failures = 0;
};

// Points through three increments of two calls each; a call that fails is made again.
Outcome run(long failing_allocation) {
  grainlaw_calculix_release(&material);
  Outcome result;
  result.stresses.reserve(100);
  std::array<double, 9> F0{1, 0, 0, 0, 1, 0, 0, 0, 1}, F1 = F0;
  const auto call = [&](int point) {
    std::array<double, 6> stress;
    std::array<double, 21> stiffness;
    stress.fill(std::nan(""));
    stiffness.fill(std::nan(""));
    double pnewdt = -1;
    grainlaw_calculix_evaluate(&material, 1, point, F0.data(), F1.data(), 1, 0, stress.data(),
                               stiffness.data(), &pnewdt);
    for (const double value : stress) EXPECT_TRUE(std::isfinite(value));
    for (const double value : stiffness) EXPECT_TRUE(std::isfinite(value));
    EXPECT_GT(stiffness[0], 0);
    if (pnewdt > 0) {
      EXPECT_LT(pnewdt, 1);
      return false;
    }
    result.stresses.push_back(stress);
    return true;
  };
  fail_allocation(failing_allocation);
  for (int increment = 0; increment < 3; ++increment) {
    for (int iteration = 0; iteration < 2; ++iteration) {
      F1[3] = 1e-4 * (increment + 1) + 1e-5 * iteration;
      for (int point = 1; point <= 3; ++point) {
        if (!call(point)) {
          ++result.failures;
          EXPECT_TRUE(call(point));
        }
      }
    }
    F0 = F1;
  }
  fail_allocation(0);
  return result;
}

TEST(calculix_memory, that_runs_out_once_changes_nothing) {
  const Outcome whole = run(0);
  long tried = 0;
  while (true) {
    const Outcome failing = run(++tried);
    EXPECT_EQ(failing.stresses, whole.stresses) << tried;
    if (failing.failures == 0) break;
    EXPECT_EQ(failing.failures, 1);
  }
  EXPECT_GT(tried, 5);
}

}  // namespace
}  // namespace grainlaw::test
