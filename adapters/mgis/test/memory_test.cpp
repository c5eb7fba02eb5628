// A call in which any one allocation fails: -1 and a text, nothing of the host's changed; the same
// call again gives what it would have given, and no state is lost or left over.
#include "../../point/test/failing_allocation.hpp"

#include <grainlaw/mgis.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace grainlaw::test {
namespace {

grainlaw_mgis_behaviour behaviour{"Idle", "/idle.toml", nullptr};

struct Outcome {
  std::vector<std::array<double, 4>> stresses;
  int failures = 0;
  std::size_t states = 0;
};

// Points through three steps of two calls each; a call that fails is made again.
Outcome run(long failing_allocation) {
  constexpr std::size_t points = 3;
  grainlaw_mgis_release(&behaviour);
  Outcome result;
  result.stresses.reserve(100);
  std::array<double, 5> F0{1, 1, 1, 0, 0}, F1 = F0;
  std::array<std::array<double, 2>, points> internal0{}, internal1{};
  const auto call = [&](std::size_t p) {
    std::array<double, 4> stress{7, 7, 7, 7};
    std::array<double, 20> K;
    K.fill(7);
    K[0] = 4;
    K[1] = K[2] = 0;
    std::array<char, 512> text{};
    double rdt = 1;
    grainlaw_mgis_data data{};
    data.error_message = text.data();
    data.rdt = &rdt;
    data.K = K.data();
    data.s0.gradients = F0.data();
    data.s1.gradients = F1.data();
    data.s0.internal_state_variables = internal0[p].data();
    data.s1.internal_state_variables = internal1[p].data();
    data.s1.thermodynamic_forces = stress.data();
    const auto before = internal1[p];
    const bool done = grainlaw_mgis_integrate(&behaviour, 2, &data) == 1;
    if (done) {
      result.stresses.push_back(stress);
      return true;
    }
    EXPECT_NE(std::string(text.data()).find("Idle: "), std::string::npos);
    EXPECT_EQ(stress, (std::array<double, 4>{7, 7, 7, 7}));
    EXPECT_TRUE(std::all_of(K.begin() + 3, K.end(), [](double value) { return value == 7; }));
    EXPECT_EQ(internal1[p], before);
    return false;
  };
  fail_allocation(failing_allocation);
  for (int step = 0; step < 3; ++step) {
    for (int iteration = 0; iteration < 2; ++iteration) {
      F1[3] = 1e-4 * (step + 1) + 1e-5 * iteration;
      for (std::size_t p = 0; p < points; ++p) {
        if (!call(p)) {
          ++result.failures;
          EXPECT_TRUE(call(p));
        }
      }
    }
    F0 = F1;
    internal0 = internal1;
  }
  fail_allocation(0);
  result.states = grainlaw_mgis_states(&behaviour);
  return result;
}

TEST(mgis_memory, that_runs_out_once_changes_nothing) {
  const Outcome whole = run(0);
  long tried = 0;
  while (true) {
    const Outcome failing = run(++tried);
    EXPECT_EQ(failing.stresses, whole.stresses) << tried;
    EXPECT_EQ(failing.states, whole.states) << tried;
    if (failing.failures == 0) break;
    EXPECT_EQ(failing.failures, 1);
  }
  EXPECT_GT(tried, 10);
}

}  // namespace
}  // namespace grainlaw::test
