// Steps in parts: what a failure is cut to, and what is told meanwhile and in the end.
#include "app/parts.hpp"
#include "dns/scene.hpp"
#include "fe/solver/newton.hpp"
#include "fe/solver/relaxation.hpp"
#include "point/driver.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace verification {
namespace {

Step step_of(double length, int max_cuts, double loose_tolerance = 0) {
  Step step{.to = length, .name = "step 1", .loose_tolerance = loose_tolerance};
  step.options.max_cuts = max_cuts;
  return step;
}

TEST(parts, a_failure_is_cut_and_the_rest_grows_again) {
  std::vector<double> tried, lengths, cut;
  Step step = step_of(1, 4);
  step.observe_cut = [&](double part, const std::string& reason) {
    cut.push_back(part);
    EXPECT_EQ(reason, "no balance");
  };
  const Parts parts = make_step(step, [&](double load, double length) -> std::optional<Refusal> {
    tried.push_back(load);
    lengths.push_back(length);
    if (tried.size() > 2) return {};
    return Refusal{.reason = "no balance"};
  });
  EXPECT_EQ(tried, (std::vector<double>{1, 0.5, 0.25, 0.75, 1}));
  EXPECT_EQ(lengths, (std::vector<double>{1, 0.5, 0.25, 0.5, 0.25}));
  EXPECT_EQ(cut, (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(parts.cuts, 2);
  EXPECT_EQ(parts.loose, 0);
}

TEST(parts, a_failure_in_the_smallest_part_says_how_far_the_step_came) {
  try {
    make_step(step_of(2, 2), [](double load, double) -> std::optional<Refusal> {
      if (load <= 1) return {};
      return Refusal{.reason = "no balance", .status = GRAINLAW_COLLAPSED};
    });
    ADD_FAILURE() << "nothing was told";
  } catch (const StepError& error) {
    EXPECT_EQ(std::string(error.what()),
              "step 1 failed 50 % along, in parts of 2.5e-01 of it too: no balance");
    EXPECT_EQ(error.status, GRAINLAW_COLLAPSED);
  }
}

// Its residual falls to a tenth and stays there.
class Stalling final : public StepMaker {
 public:
  void begin(double load, double length) override {
    loads.push_back(load);
    lengths.push_back(length);
  }
  void solve(Telling& tell) override { tell.found(0.1); }
  void keep() override {}
  void cross(Telling&) override { ADD_FAILURE() << "crossed"; }
  void accept(bool) override { ++accepted; }
  void back(bool) override {}
  std::vector<double> loads, lengths;
  int accepted = 0;
};

TEST(parts, the_rest_of_a_step_is_tried_once_with_the_loose_tolerance) {
  Stalling maker;
  const Parts parts = make_step(step_of(2, 1, 0.2), maker);
  EXPECT_EQ(maker.loads, (std::vector<double>{2, 1, 2}));
  EXPECT_EQ(maker.lengths, (std::vector<double>{2, 1, 2}));
  EXPECT_EQ(maker.accepted, 1);
  EXPECT_EQ(parts.loose, 1);
  EXPECT_EQ(parts.cuts, 2);
}

TEST(parts, a_step_without_length_is_tried_loose_too_and_its_failure_is_told) {
  Stalling maker;
  try {
    make_step(step_of(0, 4, 0.05), maker);
    ADD_FAILURE() << "nothing was told";
  } catch (const ComputationError& error) {
    EXPECT_EQ(std::string(error.what()),
              "step 1 failed: Newton did not converge: best relative residual 1.0e-01, expected "
              "1.0e-08 [-]; with loose_tolerance: Newton did not converge: best relative residual "
              "1.0e-01, expected 5.0e-02 [-]");
  }
  EXPECT_EQ(maker.loads.size(), 2);
  EXPECT_EQ(make_step(step_of(0, 4, 0.2), maker).loose, 1);
}

// Goes beyond a jump, from where a point refuses.
class Jumping final : public StepMaker {
 public:
  void begin(double load, double length) override {
    loads.push_back(load);
    lengths.push_back(length);
  }
  void solve(Telling& tell) override {
    if (beyond_ == 0) return tell.found(0.1, 1);
    if (beyond_++ == 1) return tell.refused({.reason = "no balance", .ratio = 0.5});
    tell.found(0);
  }
  void keep() override {}
  void cross(Telling& tell) override { tell.found(0.1); }
  void accept(bool beyond) override { beyond_ += beyond ? 1 : 0; }
  void back(bool left) override { left_ += left ? 1 : 0; }
  [[nodiscard]] int left() const { return left_; }
  std::vector<double> loads, lengths;

 private:
  int beyond_ = 0, left_ = 0;
};

TEST(parts, what_is_left_beyond_a_jump_is_where_the_next_part_begins) {
  Jumping maker;
  Step step = step_of(1, 10);
  step.options.crossing_part = 0.5;
  const Parts parts = make_step(step, maker);
  EXPECT_EQ(maker.loads, (std::vector<double>{1, 0.5, 0.5, 1}));
  EXPECT_EQ(maker.lengths, (std::vector<double>{1, 0.5, 0.5, 0.5}));
  EXPECT_EQ(maker.left(), 1);
  EXPECT_EQ(parts.crossed, 1);
  EXPECT_EQ(parts.loose, 1);
  EXPECT_EQ(parts.cuts, 1);
}

TEST(parts, defaults_of_step_control_are_those_of_the_march) {
  const grainlaw_march_options march = grainlaw_march_options_default();
  const NewtonOptions newton;
  EXPECT_EQ(newton.tolerance, march.tolerance);
  EXPECT_EQ(newton.max_iterations, march.max_iterations);
  EXPECT_EQ(newton.max_cuts, march.max_cuts);
  EXPECT_EQ(newton.patience, march.patience);
  EXPECT_EQ(newton.largest_correction, march.largest_correction);
  EXPECT_EQ(RelaxationOptions{}.max_cuts, march.max_cuts);
  EXPECT_EQ(SpecimenScene{}.max_cuts, march.max_cuts);
  const PointOptions point;
  EXPECT_EQ(point.tolerance, march.tolerance);
  EXPECT_EQ(point.max_iterations, march.max_iterations);
}

}  // namespace
}  // namespace verification
