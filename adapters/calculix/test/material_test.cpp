// The material of CalculiX, called as the solver calls it.
#include "../../point/test/traps.hpp"
#include "ccx_host.hpp"
#include "reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

namespace grainlaw::test {
namespace {

constexpr F2 path[] = {{0.9996, 0.0003, -0.0001, 1.0002},
                       {0.9990, 0.0012, -0.0004, 1.0005},
                       {0.9982, 0.0024, -0.0009, 1.0010}};
constexpr F2 elsewhere{1.0005, -0.0010, 0.0002, 0.9990};

const std::string materials = GRAINLAW_MATERIALS;

class calculix_material : public testing::Test {
 protected:
  MaterialLibrary library{materials + "/libGRAIN.so"};

  Host host(int element = 1, int point = 1) const {
    return {library.function("SMALL"), element, point};
  }
  static grainlaw::State direct_state(const std::string& file = materials + "/../small.toml") {
    return grainlaw::State(grainlaw::Material::load(file));
  }
  static void expect_reference(const Host& host, const Reference& expected) {
    const auto [stress, stiffness] = distance(expected, host.stress.data(), host.stiffness.data());
    EXPECT_LE(stress, 1e-12);
    EXPECT_LE(stiffness, 1e-12);
  }
};

TEST_F(calculix_material, patch_gives_S_and_the_symmetric_part_of_the_tangent) {
  Host point(library.function("RVE"), 1, 1);
  grainlaw::State state = direct_state(GRAINLAW_TEST_DATA "/rve400.toml");
  std::ifstream file(GRAINLAW_PATCH);
  std::string line;
  std::getline(file, line);
  int steps = 0;
  while (std::getline(file, line)) {
    F2 F{};
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &F[0], &F[1], &F[2], &F[3]), 4);
    ASSERT_TRUE(point.call(columns(F)));
    const Reference expected = reference(state, F, true);
    expect_reference(point, expected);
    if (++steps == 4) {
      EXPECT_GT(expected.skew, 1e-2);  // what CalculiX cannot be given
    }
    ASSERT_TRUE(point.increment({F}));
  }
  EXPECT_EQ(steps, 4);
}

TEST_F(calculix_material, increments_with_iterations_are_committed_once) {
  Host point = host();
  grainlaw::State state = direct_state();
  for (const F2& F : path) {
    ASSERT_TRUE(point.increment({elsewhere, F, elsewhere, F}));
    const Reference expected = reference(state, F, true);
    Host again = point;
    again.stress = {};
    EXPECT_TRUE(again.call(columns(F), true));  // the stress alone, after the increment
    expect_reference(again, expected);
  }
}

TEST_F(calculix_material, calls_at_a_known_F_give_the_same_bits) {
  Host point = host();
  ASSERT_TRUE(point.call(columns(path[0])));
  const Host first = point;
  point.stress = {};
  ASSERT_TRUE(point.call(columns(path[0]), true));
  EXPECT_EQ(point.stress, first.stress);
  point.stiffness = {};
  ASSERT_TRUE(point.call(columns(path[0])));
  EXPECT_EQ(point.stiffness, first.stiffness);
}

TEST_F(calculix_material, an_accepted_answer_that_was_not_the_last_is_found_again) {
  Host point = host();
  grainlaw::State state = direct_state();
  ASSERT_TRUE(point.increment({path[0]}));
  reference(state, path[0], true);
  ASSERT_TRUE(point.call(columns(path[1])));
  ASSERT_TRUE(point.call(columns(elsewhere)));
  reference(state, path[1], true);
  point.F0 = columns(path[1]);
  ASSERT_TRUE(point.call(columns(path[2])));
  expect_reference(point, reference(state, path[2], false));
}

TEST_F(calculix_material, an_increment_that_was_cut_ends_like_the_same_increments_uncut) {
  constexpr double target = 0.7;  // simple shear; more than the library takes at once
  const auto made = [&](int element) { return Host(library.function("BONDED"), element, 1); };
  Host point = made(1);
  std::vector<double> shears;
  double shear = 0, step = target;
  int cuts = 0;
  while (shear < target - 1e-9) {
    const double next = std::min(shear + step, target);
    if (!point.increment({{1, next, 0, 1}})) {
      ASSERT_LT(point.pnewdt, 1);
      EXPECT_GT(point.stiffness[0], 1e6);  // what the solver goes on with before it cuts
      step *= point.pnewdt;
      ASSERT_LT(++cuts, 10);
      continue;
    }
    shears.push_back(shear = next);
  }
  EXPECT_GE(cuts, 1);
  Host uncut = made(2);
  for (const double s : shears) ASSERT_TRUE(uncut.increment({{1, s, 0, 1}}));
  EXPECT_EQ(point.stress, uncut.stress);
}

// Drag takes moments, so that P F^T is not symmetric: CalculiX gets the symmetric part.
TEST_F(calculix_material, a_law_in_time_gets_the_time_of_the_increment) {
  Host point(library.function("INTIME"), 1, 1);
  grainlaw::State state = direct_state(materials + "/../in_time.toml");
  double dtime = 0.5;
  for (const F2& F : path) {
    point.dtime = 4 * dtime;  // cut by the host
    point.call(columns(F));
    point.dtime = dtime;
    ASSERT_TRUE(point.increment({elsewhere, F}));
    state.set_time_step(dtime);
    expect_reference(point, reference(state, F, true));
    dtime *= 2;
  }
}

TEST_F(calculix_material, points_in_threads_give_the_bits_of_one_thread) {
  const auto run = [&](int threads, int first_element) {
    constexpr int points = 8;
    std::vector<Host> hosts;
    for (int p = 0; p < points; ++p) hosts.push_back(host(first_element, p + 1));
    std::vector<std::thread> pool;
    for (int t = 0; t < threads; ++t) {
      pool.emplace_back([&, t] {
        for (const F2& F : path) {
          for (int p = t; p < points; p += threads) {
            F2 own = F;
            own[0] -= 1e-5 * p;
            EXPECT_TRUE(hosts[static_cast<std::size_t>(p)].increment({elsewhere, own}));
          }
        }
      });
    }
    for (std::thread& thread : pool) thread.join();
    std::vector<std::array<double, 6>> stresses;
    for (const Host& each : hosts) stresses.push_back(each.stress);
    return stresses;
  };
  EXPECT_EQ(run(4, 20), run(1, 10));
}

class calculix_bad_input : public calculix_material {
 protected:
  // The call asks for a cut and prints the text; the state is as it was.
  void refused(Host point, const std::array<double, 9>& F1, const char* text) {
    testing::internal::CaptureStdout();
    {
      const Traps traps;
      EXPECT_FALSE(point.call(F1));
      EXPECT_TRUE(Traps::there());
    }
    const std::string output = testing::internal::GetCapturedStdout();
    EXPECT_NE(output.find("*ERROR in grainlaw"), std::string::npos) << output;
    EXPECT_NE(output.find(text), std::string::npos) << output;
    EXPECT_EQ(point.pnewdt, grainlaw_march_cut(NAN));
    for (const double value : point.stiffness) EXPECT_TRUE(std::isfinite(value));
  }
};

TEST_F(calculix_bad_input, leaves_the_state_as_it_was) {
  Host point = host();
  grainlaw::State state = direct_state();
  ASSERT_TRUE(point.increment({path[0]}));
  reference(state, path[0], true);
  auto F = columns(path[1]);
  F[3] = std::numeric_limits<double>::quiet_NaN();
  refused(point, F, "element 1, point 1: F12 of the deformation gradient is nan");
  Host lost = point;
  lost.F0[4] = std::numeric_limits<double>::quiet_NaN();
  refused(lost, columns(path[1]), "F22 of the deformation gradient is nan");
  F = columns(path[1]);
  F[8] = 1.02;
  refused(point, F, "F33 is 1.02");
  ASSERT_TRUE(point.call(columns(path[1])));
  expect_reference(point, reference(state, path[1], false));
}

TEST_F(calculix_bad_input, a_start_elsewhere_is_told) {
  Host point = host(7);
  point.F0 = columns(path[1]);
  refused(point, columns(path[2]), "cannot be restarted without its states");
}

TEST_F(calculix_bad_input, a_law_in_time_without_a_time) {
  Host point(library.function("INTIME"), 1, 2);
  point.dtime = 0;
  ASSERT_TRUE(point.increment({{1, 0, 0, 1}}));  // of nothing
  refused(point, columns(path[0]), "no time step above 0");
  point.dtime = 1;
  EXPECT_TRUE(point.call(columns(path[0])));
}

// Discs that do not turn carry moments: in shear S12 and S21 differ.
TEST_F(calculix_bad_input, a_stress_that_is_not_symmetric) {
  Host point(library.function("LOCKED"), 1, 1);
  constexpr F2 sheared{1, 1e-3, 0, 1};
  refused(point, columns(sheared), "the stress of this packing is not symmetric (S12 and S21");
  testing::internal::CaptureStdout();
  EXPECT_FALSE(point.call(columns(sheared), true));
  EXPECT_FALSE(point.call(columns(sheared)));  // still
  testing::internal::GetCapturedStdout();
}

TEST_F(calculix_bad_input, gives_stress_and_elastic_stiffness_of_the_start) {
  Host point = host();
  grainlaw::State state = direct_state();
  ASSERT_TRUE(point.increment({path[0]}));
  const std::array<double, 6> accepted = point.stress;
  reference(state, path[0], true);
  const Reference expected = reference(state, path[0], false, GRAINLAW_WANT_TANGENT_ELASTIC);
  auto nothing = columns(path[1]);
  nothing[0] = std::numeric_limits<double>::infinity();
  for (const auto& F : {nothing, columns({1.6, 0, 0, 1})}) {
    point.stress = {};
    point.stiffness = {};
    testing::internal::CaptureStdout();
    EXPECT_FALSE(point.call(F));
    testing::internal::GetCapturedStdout();
    for (std::size_t k = 0; k < 6; ++k) {  // found again, to the tolerance of the packing
      EXPECT_NEAR(point.stress[k], accepted[k], 1e-6 * std::abs(accepted[0]));
    }
    expect_reference(point, expected);
    EXPECT_GT(point.stiffness[0], 1e6);  // Pa
  }
}

TEST_F(calculix_bad_input, of_two_points_in_turn_is_told_once_each) {
  Host first = host(1, 1), second = host(1, 2);
  auto F = columns(path[0]);
  F[3] = std::numeric_limits<double>::quiet_NaN();
  const auto told = [&](Host& point) {
    testing::internal::CaptureStdout();
    EXPECT_FALSE(point.call(F));
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_NE(told(first).find("point 1: F12"), std::string::npos);
  EXPECT_NE(told(second).find("point 2: F12"), std::string::npos);
  EXPECT_EQ(told(first), "");
  EXPECT_EQ(told(second), "");
}

TEST_F(calculix_bad_input, of_very_many_points_is_told_for_the_first_thousand) {
  auto F = columns(path[0]);
  F[3] = std::numeric_limits<double>::quiet_NaN();
  testing::internal::CaptureStdout();
  for (int element = 1; element <= 1100; ++element) EXPECT_FALSE(host(element).call(F));
  const std::string output = testing::internal::GetCapturedStdout();
  EXPECT_NE(output.find("element 1000, "), std::string::npos);
  EXPECT_EQ(output.find("element 1001, "), std::string::npos);
  EXPECT_NE(output.find("no more errors are printed"), std::string::npos);
}

TEST_F(calculix_material, is_found_beside_a_library_of_a_relative_path_from_elsewhere) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(materials);
  const MaterialLibrary by_hand("./libBYHAND.so");
  std::filesystem::current_path("/");
  Host point(by_hand.function("BESIDE"), 1, 1);
  EXPECT_TRUE(point.call(columns(path[0])));
  std::filesystem::current_path(before);
}

TEST_F(calculix_bad_input, a_missing_material_file_is_told_once) {
  const MaterialLibrary by_hand(materials + "/libBYHAND.so");
  Host point(by_hand.function("MISSING"), 1, 1);
  refused(point, columns(path[0]), "/no_such_material.toml");
  testing::internal::CaptureStdout();
  EXPECT_FALSE(point.call(columns(path[0])));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace grainlaw::test
