// One integration point led along a path: steps in parts, and what is left of one that fails.
#include "../temporary_directory.hpp"
#include "point/driver.hpp"
#include "point/scene.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace verification {
namespace {

constexpr double pressure = 1e5;
Segment compression() { return drained_segment(-2e-3, -pressure, 2); }

// One iteration is too few for a whole step.
PointOptions hurried(int max_cuts) { return {.max_iterations = 1, .max_cuts = max_cuts}; }

TEST(point, a_step_that_fails_is_made_in_parts_and_ends_at_the_same_stress) {
  PointDriver whole(lattice_material(), {});
  PointDriver parts(lattice_material(), hurried(12));
  int observed = 0;
  const auto observe = [&](const PointStep& step) {
    ++observed;
    EXPECT_GT((step.record.deformation - step.committed_deformation).norm(), 0);
  };
  std::vector<double> cuts;
  whole.run(compression(), observe);
  parts.run(compression(), observe, [&](double part, const std::string& reason) {
    cuts.push_back(part);
    EXPECT_NE(reason.find("Newton did not converge: best relative residual"), std::string::npos)
        << reason;
  });
  EXPECT_EQ(observed, 4);
  ASSERT_FALSE(cuts.empty());
  EXPECT_EQ(cuts.front(), 0.5);
  EXPECT_EQ(whole.record().effort.cuts, 0);
  EXPECT_GT(parts.record().effort.cuts, 0);
  EXPECT_EQ(parts.record().step, 2);
  EXPECT_NEAR(parts.record().cauchy(0, 0), -pressure, 1e-6 * pressure);
  const Tensor& stress = whole.record().stress;
  EXPECT_LT((parts.record().stress - stress).norm(), 1e-4 * stress.norm());
}

TEST(point, a_step_that_fails_at_its_smallest_says_where_and_leaves_those_before) {
  PointDriver point(lattice_material(), hurried(0));
  const Segment small = drained_segment(-1e-6, -pressure, 1);
  point.run(small, {});
  const Tensor before = point.record().deformation;
  try {
    point.run(compression(), {});
    ADD_FAILURE() << "nothing was told";
  } catch (const StepError& error) {
    const std::string text = error.what();
    EXPECT_EQ(error.status, GRAINLAW_OK);
    EXPECT_EQ(text.find("step 2 (from F22 = 0.999999, F12 = 0.000000) failed"), 0U) << text;
  }
  EXPECT_EQ(point.record().step, 1);
  EXPECT_EQ(point.record().deformation, before);
  point.run(small, {});
  EXPECT_EQ(point.record().step, 2);
  EXPECT_NEAR(point.record().deformation(1, 1), before(1, 1) - 1e-6, 1e-12);
}

TEST(point, an_evaluation_that_is_refused_is_the_status_of_the_failure) {
  PointDriver point(lattice_material(), {.max_cuts = 0});
  try {
    point.run(shear_segment(1, 1), {});
    ADD_FAILURE() << "nothing was told";
  } catch (const StepError& error) {
    EXPECT_EQ(error.status, GRAINLAW_STEP_TOO_LARGE) << error.what();
  }
}

// Past its peak this packing rearranges: P, a function of F and the last commit, jumps across the lateral stress.
TEST(point, jumps_of_the_stress_are_crossed_and_every_step_ends_in_balance) {
  const grainlaw::test::TemporaryDirectory directory;
  std::ofstream(directory / "scene.toml") << R"(
[material]
dimension = 2
thickness = 0.02
packing = { generator = "compaction", count = 120, radii = [2.5e-3, 5e-3], pressure = 50e3, friction = 0.0, seed = 5 }
contact = { law = "frictional", young = 5e7, ratio = 0.5, friction = 0.8 }
[[segment]]
steps = 40
F22 = 0.96
sigma11 = -50e3
)";
  const PointScene scene = read_point_scenes(SceneFile(directory / "scene.toml")).front();
  PointDriver driver(make_material(scene.material), scene.options);
  int crossed = 0;
  driver.run(scene.segments.front(), [&](const PointStep& step) {
    crossed += step.record.effort.crossed;
    EXPECT_EQ(step.record.effort.loose, 0);
    const double scale = step.record.cauchy.norm();
    EXPECT_NEAR(step.record.cauchy(0, 0), -50e3, 1e-7 * scale) << step.record.step;
  });
  EXPECT_EQ(driver.record().step, 40);
  EXPECT_GT(crossed, 0);
}

TEST(point, a_material_that_starts_from_its_trial_bounds_the_tolerance) {
  const grainlaw::test::TemporaryDirectory directory;
  const auto read = [&](const std::string& solver, const std::string& tolerance) {
    std::ofstream(directory / "scene.toml") << tolerance << "\nmaterial.solver = { start = 'trial'"
                                            << solver << " }\n[[segment]]\nsteps = 1\nF22 = 0.99\n";
    return read_point_scenes(SceneFile(directory / "scene.toml")).front().options.tolerance;
  };
  EXPECT_EQ(read("", ""), 1e-8);
  EXPECT_EQ(read(", tolerance = 1e-6", ""), 1e-6);
  EXPECT_EQ(read(", tolerance = 1e-6", "tolerance = 1e-5"), 1e-5);
  try {
    read(", tolerance = 1e-6", "tolerance = 1e-7");
    ADD_FAILURE() << "nothing was told";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("scene.toml:1: tolerance: found 1e-07"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace verification
