// Nonsense is refused before anything is computed; what is unusual at the start is told, and a failure
// near it says what the packing is like.
#include "point/start.hpp"

#include "../temporary_directory.hpp"
#include "point/run.hpp"
#include "point/scene.hpp"
#include "scene_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace verification {
namespace {

class start : public testing::Test {
 protected:
  PointScene read(const std::string& segment, const std::string& material = small_packing) {
    const std::filesystem::path path = directory_.path() / "scene.toml";
    std::ofstream(path) << "figure = false\nmay_end = true\n"
                        << material << "[[segment]]\n"
                        << segment;
    return read_point_scenes(SceneFile(path)).front();
  }

  void expect_refused(const std::string& segment, const std::string& told) {
    try {
      read("steps = 10\n" + segment);
      ADD_FAILURE() << "accepted: " << segment;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(told), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
  }

  PointEnd run(const PointScene& scene) {
    PointEnd end;
    run_point(scene, directory_.path() / "out", end);
    return end;
  }

  // What is unusual in a packing of thirty discs after a change to its text.
  std::string unusual(const std::string& from, const std::string& to) {
    std::string text = small_packing;
    text.replace(text.find(from), from.size(), to);
    const PointScene scene = read("steps = 1\ndF22 = -1e-6\n", text);
    const State state(make_material(scene.material));
    return measure_start(state.get(), scene.material).text();
  }

  const grainlaw::test::TemporaryDirectory directory_;
};

TEST_F(start, a_strain_in_the_place_of_a_stretch_is_refused) {
  expect_refused("F22 = 0.001\n", "].F22: found 0.001, expected a stretch: 1 undeformed");
  expect_refused("F11 = 0.05\n", "dF11 = -0.01 adds");
  expect_refused("dF22 = -5\n", "].dF22: found -5, which leads to F22 = -4");
  expect_refused("dF22 = -0.3\n[[segment]]\nsteps = 1\ndF22 = -0.3\n", "leads to F22 = 0.4");
  read("steps = 10\nF22 = 0.9\nF11 = 1.1\n");
}

TEST_F(start, tension_is_refused_unless_there_are_bonds) {
  expect_refused("dF22 = -0.01\nsigma11 = 50e3\n",
                 "].sigma11: found 50000, which is tension, expected a number <= 0, -50000 Pa");
  expect_refused("P22 = 1e5\n", "].P22: found 100000");
  std::string bonded = small_packing;
  const std::string law = "\"frictional\"";
  bonded.replace(bonded.find(law), law.size(),
                 "\"bonded\", bond = { normal_strength = 1, tangential_strength = 1 }");
  EXPECT_NO_THROW(read("steps = 1\nsigma11 = 5\n", bonded));
}

TEST_F(start, of_an_ordinary_packing_is_not_unusual) {
  const std::string text = unusual("friction = 0.5", "friction = 0.5");
  EXPECT_EQ(text.find("unusual"), std::string::npos) << text;
  EXPECT_EQ(text.find("mean pressure 1e+05 Pa, kn/p "), 0U) << text;
}

TEST_F(start, with_units_that_are_hardly_meant_is_told) {
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(unusual("friction = 0.5", "friction = 30"),
         "contact.friction = 30 is tan(88.1 degrees); tan(30 degrees) is 0.577");
  expect(unusual("pressure = 1e5", "pressure = 0.1"), "a mean pressure of 0.1 Pa");
  expect(unusual("young = 6e8", "young = 4e7"), "soft: usual are");
  expect(unusual("young = 6e8", "young = 6e14"), "stiff: steps have to be as small");
}

TEST_F(start, targets_in_other_units_are_told) {
  const PointScene scene = read("steps = 1\nsigma11 = -100\n");
  PackingStart begin;
  begin.pressure = 1e5;
  const auto texts = far_targets(begin, scene.segments);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0],
            "a target of -100 Pa in direction 1 for a packing under 1e+05 Pa: is it in Pa?");
}

TEST_F(start, stresses_of_a_laboratory_test_in_other_units_are_told) {
  PackingStart begin;
  begin.pressure = 1e5;
  for (const auto& [keys, told] : std::vector<std::pair<std::string, std::string>>{
           {"test = 'isotropic'\npressure = 100", "pressure = 100 Pa for a packing"},
           {"test = 'k0'\naxial_stress = 100", "axial_stress = 100 Pa"},
           {"test = 'drained'\nlateral_stress = 2e8", "lateral_stress = 2e+08 Pa"},
           {"test = 'drained'\nstop = { q = 50 }", "stop.q = 50 Pa"},
           {"test = 'undrained'\ncycles = 1\namplitude = { q = 30 }", "amplitude.q = 30 Pa"}}) {
    const auto texts = far_targets(begin, read(keys + "\n").segments);
    ASSERT_EQ(texts.size(), 1U) << keys;
    EXPECT_NE(texts[0].find(told), std::string::npos) << texts[0];
  }
  EXPECT_TRUE(far_targets(begin, read("test = 'k0'\naxial_stress = 5e5\n").segments).empty());
  EXPECT_TRUE(far_targets(begin, read("test = 'isotropic'\n").segments).empty());
}

TEST_F(start, a_failure_in_the_first_steps_says_what_the_packing_is_like_and_what_to_try) {
  PointScene scene = read("steps = 2\ndF22 = -0.1\nsigma11 = -100e3\n");
  scene.options.max_cuts = 0;
  scene.options.max_iterations = 1;
  const PointEnd end = run(scene);
  EXPECT_LT(end.steps, end.steps_wanted);
  EXPECT_NE(end.text.find("; the packing starts with mean pressure 1e+05 Pa, kn/p "),
            std::string::npos)
      << end.text;
  EXPECT_NE(end.text.find("steps or more instead of 2: each strains by 0.05"), std::string::npos)
      << end.text;
}

TEST_F(start, of_a_path_that_leaves_the_usual_stiffness_is_told_once) {
  const PointScene scene = read("test = 'isotropic'\npressure = 20e6\nsteps = 20\n");
  testing::internal::CaptureStderr();
  const PointEnd end = run(scene);
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_EQ(end.status, GRAINLAW_OK) << end.text;
  const auto first = told.find("unusual from step ");
  ASSERT_NE(first, std::string::npos) << told;
  EXPECT_NE(told.find(" on: kn/p = 2", first), std::string::npos) << told;
  EXPECT_EQ(told.find("unusual from step ", first + 1), std::string::npos) << told;
}

// Smooth and soft: P jumps under stresses that are far apart.
TEST_F(start, of_parts_that_a_step_left_out_of_balance_is_told_once) {
  int left = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::string text = small_packing_of_seed(seed);
    const std::string law = "law = \"frictional\", young = 6e8, ratio = 0.8, friction = 0.5";
    text.replace(text.find(law), law.size(), "law = \"compressive\", young = 5e7");
    const PointScene scene = read("steps = 3\nsigma11 = -70e3\nsigma22 = -200e3\n", text);
    testing::internal::CaptureStderr();
    const PointEnd end = run(scene);
    const std::string told = testing::internal::GetCapturedStderr();
    const auto first = told.find(" out of balance, across jumps of the stress");
    EXPECT_EQ(first != std::string::npos, end.effort.loose > 0) << told;
    if (first == std::string::npos) continue;
    ++left;
    EXPECT_EQ(told.find(" out of balance", first + 1), std::string::npos) << told;
  }
  EXPECT_GT(left, 0);
}

TEST_F(start, a_stress_beyond_the_strength_is_told_once_and_strain_is_advised) {
  for (int seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    PointScene scene =
        read("steps = 10\nsigma22 = -1000e3\nsigma11 = -100e3\n", small_packing_of_seed(seed));
    scene.may_end = false;
    testing::internal::CaptureStdout();
    std::string told;
    try {
      run(scene);
    } catch (const ComputationError& error) {
      told = error.what();
    }
    const std::string out = testing::internal::GetCapturedStdout();
    EXPECT_NE(told.find("the packing may not carry this stress: prescribe F22, not sigma22"),
              std::string::npos)
        << told;
    EXPECT_EQ(told.find("tolerance"), std::string::npos) << told;
    EXPECT_EQ(out.find("ended:"), std::string::npos) << out;
  }
}

}  // namespace
}  // namespace verification
