// Sets of points: the answers of their states, and all of them or none.
#include "points_support.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::test {
namespace {

TEST(points, give_the_bits_of_a_batch_for_any_number_of_threads) {
  auto single = states();
  const Result expected = evaluate(single, 1);
  for (State& state : single) state.commit();
  for (const int threads : {1, 2, 4, 8, 0}) {
    Points set = make_set();
    for (int round = 0; round < 2; ++round) {  // the second one ordered by cost
      const Result found = evaluate(set, threads);
      EXPECT_TRUE(same_bits(expected, found)) << threads << " threads";
      for (std::size_t k = 0; k < points; ++k) {
        EXPECT_EQ(found.status[k], GRAINLAW_OK);
        EXPECT_EQ(expected.report[k].relaxation_steps, found.report[k].relaxation_steps);
      }
    }
    set.commit();
    for (std::size_t k = 0; k < points; ++k)
      EXPECT_TRUE(same_bits(single[k].save(), save_one(set.state(k))));
  }
}

TEST(points, tell_the_first_failed_one_fatal_before_recoverable) {
  auto F = deformations();
  F[4 * 1] = -1;  // inverted
  F[4 * 3] = F[4 * 3 + 3] = 1.5;
  for (const int threads : {1, 4}) {
    Points set = make_set();
    const Summarised recoverable = evaluate_at(set, F, threads);
    EXPECT_EQ(recoverable.status, GRAINLAW_INVERTED);
    EXPECT_EQ(recoverable.summary.failed, 2);
    EXPECT_EQ(recoverable.summary.first_failed, 1);
    EXPECT_EQ(recoverable.summary.step_ratio, 0.1);  // of point 3, whose stretch is too large
    EXPECT_EQ(std::string(recoverable.summary.message).find("det F = "), 0U);

    auto worse = F;
    worse[4 * 6 + 1] = worse[4 * 5 + 1] = NAN;
    const Summarised fatal = evaluate_at(set, worse, threads);
    EXPECT_EQ(fatal.status, GRAINLAW_NOT_FINITE);
    EXPECT_EQ(fatal.summary.failed, 4);
    EXPECT_EQ(fatal.summary.first_failed, 5);
    EXPECT_EQ(fatal.summary.step_ratio, 0);
    EXPECT_EQ(std::string(fatal.summary.message).find("F12 is "), 0U);

    const Summarised well = evaluate_at(set, deformations(), threads);
    EXPECT_EQ(well.status, GRAINLAW_OK);
    EXPECT_EQ(well.summary.failed, 0);
    EXPECT_EQ(well.summary.first_failed, -1);
    EXPECT_EQ(well.summary.step_ratio, 1);
    EXPECT_STREQ(well.summary.message, "");
  }
}

TEST(points, with_a_failed_one_have_the_answers_of_the_others) {
  Points set = make_set();
  const Result expected = evaluate(set, 1);
  auto F = deformations();
  F[4 * 2] = -1;
  Result found;
  EXPECT_EQ(grainlaw_points_evaluate(set.get(), F.data(), 0, found.P.data(), nullptr, nullptr,
                                     nullptr, 2, nullptr),
            GRAINLAW_INVERTED);
  for (std::size_t k = 0; k < points; ++k)
    for (std::size_t m = 0; m < 4; ++m)
      EXPECT_NEAR(found.P[4 * k + m], k == 2 ? 0 : expected.P[4 * k + m], 1e-3);
}

TEST(points, are_all_committed_or_none) {
  Points set = make_set();
  const auto before = set.save();
  const auto refused = [&] {
    EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
    EXPECT_TRUE(same_bits(set.save(), before));
  };
  refused();
  for (const std::size_t failed : {std::size_t{0}, points / 2, points - 1}) {
    auto F = deformations();
    F[4 * failed] = -1;
    EXPECT_EQ(evaluate_at(set, F, 2).status, GRAINLAW_INVERTED);
    refused();
  }
  evaluate(set, 2);
  set.revert();
  refused();
  evaluate(set, 2);
  set.commit();
  EXPECT_FALSE(same_bits(set.save(), before));
  EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
}

TEST(points, clone_has_the_trials_and_is_independent) {
  Points set = make_set();
  evaluate(set, 2);
  Points clone(set);
  clone.commit();
  EXPECT_FALSE(same_bits(clone.save(), set.save()));
  set.commit();
  EXPECT_TRUE(same_bits(clone.save(), set.save()));
  EXPECT_TRUE(same_bits(evaluate(clone, 1), evaluate(set, 2)));
}

TEST(points, saved_ones_continue_with_the_same_bits) {
  Points set = make_set();
  evaluate(set, 2);
  set.commit();
  Points loaded = make_set();
  const auto* const borrowed = loaded.state(3);
  evaluate(loaded, 2);  // a trial that loading drops
  loaded.load(set.save());
  EXPECT_EQ(grainlaw_points_commit(loaded.get()), GRAINLAW_NO_TRIAL);
  EXPECT_TRUE(same_bits(loaded.save(), set.save()));
  EXPECT_EQ(loaded.state(3), borrowed);
  auto further = deformations();
  for (std::size_t k = 0; k < points; ++k) further[4 * k + 3] -= 1e-3;
  EXPECT_TRUE(same_bits(evaluate_at(loaded, further, 1).P, evaluate_at(set, further, 2).P));
}

TEST(points, one_alone_loads_the_bytes_of_its_state) {
  Points set = make_set();
  evaluate(set, 2);
  set.commit();
  Points one(material(), 1);
  one.load(save_one(set.state(3)));
  EXPECT_TRUE(same_bits(save_one(one.state(0)), save_one(set.state(3))));
  EXPECT_THROW(set.load(save_one(set.state(3))), grainlaw::StatusError);
}

TEST(points, measure_as_their_states_do) {
  Points set = make_set();
  evaluate(set, 2);
#define GRAINLAW_X(name, value, count, text)            \
  {                                                     \
    const auto all = set.measure(name);                 \
    std::vector<double> each;                           \
    for (std::size_t k = 0; k < points; ++k) {          \
      const auto one = measure_one(set.state(k), name); \
      each.insert(each.end(), one.begin(), one.end());  \
    }                                                   \
    EXPECT_TRUE(same_bits(all, each)) << text;          \
  }
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  EXPECT_EQ(set.measure(GRAINLAW_DEFORMATION_GRADIENT), deformations());
}

TEST(points, lend_states_to_read_and_to_write_as_files) {
  const Points set = make_set();
  EXPECT_EQ(set.size(), points);
  const TemporaryDirectory directory;
  const auto picture = directory / "point.vtp";
  EXPECT_EQ(grainlaw_state_write_vtk(set.state(2), picture.c_str()), GRAINLAW_OK);
  EXPECT_GT(std::filesystem::file_size(picture), 1000U);
  grainlaw_state* copy = nullptr;
  ASSERT_EQ(grainlaw_state_clone(set.state(2), &copy), GRAINLAW_OK);
  Tensor P{};
  EXPECT_EQ(grainlaw_evaluate(copy, compressed.data(), 0, P.data(), nullptr, nullptr), GRAINLAW_OK);
  grainlaw_state_destroy(copy);  // the host's own
}

TEST(points, none_are_a_set_too) {
  Points set(material(), 0);
  EXPECT_EQ(set.size(), 0U);
  const auto found = set.evaluate({}, {});
  EXPECT_TRUE(found);
  EXPECT_EQ(found.summary.first_failed, -1);
  set.commit();
  set.revert();
  EXPECT_TRUE(set.measure(GRAINLAW_FABRIC).empty());
  set.load(set.save());
  EXPECT_THROW(static_cast<void>(set.state(0)), grainlaw::StatusError);
}

TEST(points, outlive_the_handle_of_their_material) {
  grainlaw_material* handle = nullptr;
  ASSERT_EQ(grainlaw_material_load(material_path.c_str(), &handle, nullptr, 0), GRAINLAW_OK);
  grainlaw_points* set = nullptr;
  ASSERT_EQ(grainlaw_points_create(handle, 2, &set), GRAINLAW_OK);
  grainlaw_material_destroy(handle);
  const std::array<double, 8> F{1, 0, 0, 1, 1, 0, 0, 0.999};
  EXPECT_EQ(
      grainlaw_points_evaluate(set, F.data(), 0, nullptr, nullptr, nullptr, nullptr, 2, nullptr),
      GRAINLAW_OK);
  grainlaw_points_destroy(set);
}

}  // namespace
}  // namespace grainlaw::test
