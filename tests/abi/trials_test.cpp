// Trials as bytes: a point that another set evaluates is that of its owner, bit by bit.
#include "points_support.hpp"
#include "seal.hpp"

#include <grainlaw/trials.h>

#include <array>
#include <cstdint>

namespace grainlaw::test {
namespace {

using Bytes = std::vector<std::byte>;

Bytes trial_of(const Points& set, std::size_t point, int evaluated) {
  std::array<std::size_t, 2> offsets{};
  EXPECT_EQ(grainlaw_points_save_trials(set.get(), 1, &point, evaluated, nullptr, offsets.data()),
            GRAINLAW_OK);
  Bytes bytes(offsets[1]);
  EXPECT_EQ(
      grainlaw_points_save_trials(set.get(), 1, &point, evaluated, bytes.data(), offsets.data()),
      GRAINLAW_OK);
  return bytes;
}

grainlaw_status load_trial(Points& set, std::size_t point, const Bytes& bytes,
                           std::string* told = nullptr) {
  const std::array<std::size_t, 2> offsets{0, bytes.size()};
  std::array<char, 200> message{};
  const grainlaw_status status = grainlaw_points_load_trials(
      set.get(), 1, &point, bytes.data(), offsets.data(), message.data(), message.size());
  if (told != nullptr) *told = message.data();
  return status;
}

std::vector<double> at(std::size_t step) {
  auto F = deformations();
  for (std::size_t k = 0; k < points; ++k) F[4 * k + 3] -= 2e-4 * static_cast<double>(step);
  return F;
}

Result evaluate_all(Points& set, const std::vector<double>& F) {
  Result found;
  EXPECT_TRUE(set.evaluate(F, found.P, GRAINLAW_WANT_TANGENT_EXACT, found.A));
  return found;
}

// What evaluate_all() does, each point in a set of one that knows nothing but bytes.
Result evaluate_elsewhere(Points& set, Points& other, const std::vector<double>& F) {
  Result found;
  for (std::size_t k = 0; k < points; ++k) {
    other.load_some(std::array<std::size_t, 1>{0}, set.save_some(std::array{k}));
    EXPECT_EQ(load_trial(other, 0, trial_of(set, k, 0)), GRAINLAW_OK);
    EXPECT_TRUE(other.evaluate(std::span(F).subspan(4 * k, 4), std::span(found.P).subspan(4 * k, 4),
                               GRAINLAW_WANT_TANGENT_EXACT,
                               std::span(found.A).subspan(16 * k, 16)));
    EXPECT_EQ(load_trial(set, k, trial_of(other, 0, 1)), GRAINLAW_OK);
    EXPECT_EQ(set.cost()[k], other.cost()[0]);
  }
  return found;
}

class trials : public testing::TestWithParam<const char*> {
 protected:
  Material material_ =
      Material::parse(read_text(material_path) + "[solver]\n" + GetParam(), data_directory);
};

TEST_P(trials, found_elsewhere_are_those_of_their_owner) {
  Points set(material_, points), lends(material_, points), other(material_, 1);
  for (std::size_t step = 0; step < 6; step += 2) {
    for (std::size_t iteration = 0; iteration < 2; ++iteration) {
      const auto F = at(step + iteration);
      EXPECT_TRUE(same_bits(evaluate_elsewhere(lends, other, F), evaluate_all(set, F)));
      for (const auto what : {GRAINLAW_VOID_RATIO, GRAINLAW_DISSIPATED_ENERGY})
        EXPECT_TRUE(same_bits(lends.measure(what), set.measure(what)));
    }
    if (step == 2) {  // a step that is cut goes on from what was committed
      set.revert();
      lends.revert();
      continue;
    }
    set.commit();
    lends.commit();
    EXPECT_TRUE(same_bits(lends.save(), set.save()));
  }
}

INSTANTIATE_TEST_SUITE_P(of, trials,
                         testing::Values("", "start = \"trial\"\n",
                                         "start = \"trial\"\nviscous_number = 1e-3\n"));

// Where iterations start from trials, the bits depend on what save_trials() writes without
// `evaluated`; elsewhere that has no trial.
TEST(trials, bytes_have_what_the_next_one_starts_from) {
  const Material from_trials =
      Material::parse(read_text(material_path) + "[solver]\nstart = \"trial\"\n", data_directory);
  Points set(from_trials, 1), other(from_trials, 1), committed = make_set();
  const std::array<double, 4> F{1, 1e-3, 0, 0.999}, further_on{1, 1.2e-3, 0, 0.9988};
  std::array<double, 4> P{}, expected{};
  ASSERT_TRUE(set.evaluate(F, P));
  const Bytes start = trial_of(set, 0, 0);
  ASSERT_TRUE(set.evaluate(further_on, expected));
  ASSERT_TRUE(other.evaluate(further_on, P));
  EXPECT_FALSE(same_bits(P, expected));
  EXPECT_EQ(load_trial(other, 0, start), GRAINLAW_OK);
  ASSERT_TRUE(other.evaluate(further_on, P));
  EXPECT_TRUE(same_bits(P, expected));
  evaluate(committed, 1);
  EXPECT_LT(trial_of(committed, 0, 0).size(), 100U);
  EXPECT_GT(trial_of(committed, 0, 1).size(), 10000U);
}

TEST(trials, that_were_not_found_are_taken_over_as_none) {
  Points set = make_set(), other(material(), 1);
  evaluate(set, 1);
  std::array<double, 4> P{};
  EXPECT_EQ(other.evaluate(std::array<double, 4>{2, 0, 0, 1}, P).status, GRAINLAW_STEP_TOO_LARGE);
  EXPECT_EQ(load_trial(set, 3, trial_of(other, 0, 1)), GRAINLAW_OK);
  EXPECT_EQ(set.cost()[3], other.cost()[0]);
  EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
}

TEST(trials, are_loaded_all_or_none) {
  Points set = make_set(), other = make_set();
  evaluate(other, 1);
  const std::array<std::size_t, 2> which{4, 2};
  std::array<std::size_t, 3> offsets{};
  ASSERT_EQ(grainlaw_points_save_trials(other.get(), 2, which.data(), 1, nullptr, offsets.data()),
            GRAINLAW_OK);
  Bytes bytes(offsets[2]);
  ASSERT_EQ(
      grainlaw_points_save_trials(other.get(), 2, which.data(), 1, bytes.data(), offsets.data()),
      GRAINLAW_OK);
  bytes[offsets[2] - 1] ^= std::byte{1};
  std::array<char, 200> told{};
  EXPECT_EQ(grainlaw_points_load_trials(set.get(), 2, which.data(), bytes.data(), offsets.data(),
                                        told.data(), told.size()),
            GRAINLAW_BAD_BYTES);
  EXPECT_STREQ(told.data(), "point 2: saved trial: damaged or truncated");
  EXPECT_EQ(set.cost(), std::vector<double>(points));
}

TEST(bad_trials, bytes_are_refused_and_change_nothing) {
  const Material from_trials =
      Material::parse(read_text(material_path) + "[solver]\nstart = \"trial\"\n", data_directory);
  Points set(from_trials, points), other(from_trials, points);
  evaluate(set, 1);
  evaluate(other, 1);
  set.commit();
  std::vector<double> P(4 * points), A(16 * points);
  ASSERT_TRUE(set.evaluate(at(2), P, GRAINLAW_WANT_TANGENT_EXACT, A));
  const Bytes good = trial_of(other, 0, 1);
  const auto refused = [&](const Bytes& bytes, grainlaw_status expected, const std::string& what) {
    std::string told;
    expect_refused(load_trial(set, 1, bytes, &told), expected, what);
    EXPECT_EQ(told.rfind("point 1: saved ", 0), 0U) << told;
  };
  for (std::size_t size = 1; size < good.size(); size += size < 100 ? 1 : 997) {
    Bytes cut(good.begin(), good.begin() + static_cast<long>(size));
    refused(cut, GRAINLAW_BAD_BYTES, "cut to " + std::to_string(size));
    if (size < 8) continue;
    seal(cut);
    refused(cut, GRAINLAW_BAD_BYTES, "cut and sealed at " + std::to_string(size));
  }
  Bytes longer = good;
  longer.insert(longer.end() - 8, 8, std::byte{0});
  seal(longer);
  refused(longer, GRAINLAW_BAD_BYTES, "longer");
  Bytes newer = good;
  newer[8] = std::byte{2};
  seal(newer);
  refused(newer, GRAINLAW_WRONG_VERSION, "newer");
  // Sizes and numbers of slopes, wherever they stand, that do not fit.
  for (const std::size_t place : {28U, 40U}) {
    for (const std::uint64_t size : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0}}) {
      Bytes wrong = good;
      std::memcpy(&wrong[place], &size, sizeof size);
      seal(wrong);
      refused(wrong, GRAINLAW_BAD_BYTES, "a size of " + std::to_string(size));
    }
  }
  Points another(Material::load(data_directory + "/bonded100.toml"), 1);
  EXPECT_EQ(evaluate_at(another, {1, 0, 0, 0.999}, 1).status, GRAINLAW_OK);
  refused(trial_of(another, 0, 1), GRAINLAW_WRONG_MATERIAL, "of another material");
  refused(set.save_some(std::array<std::size_t, 1>{0}).bytes, GRAINLAW_BAD_BYTES, "a state");
  std::vector<double> measured = set.measure(GRAINLAW_CAUCHY_STRESS);
  Points expected(set);
  EXPECT_TRUE(same_bits(measured, expected.measure(GRAINLAW_CAUCHY_STRESS)));
  EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_OK);
}

TEST(bad_trials, calls_are_refused) {
  Points set = make_set();
  std::array<std::size_t, 2> offsets{};
  const std::size_t outside = points;
  expect_refused(grainlaw_points_save_trials(nullptr, 0, nullptr, 1, nullptr, offsets.data()),
                 GRAINLAW_NULL_POINTER, "no set");
  expect_refused(grainlaw_points_save_trials(set.get(), 1, nullptr, 1, nullptr, nullptr),
                 GRAINLAW_NULL_POINTER, "no offsets");
  expect_refused(grainlaw_points_save_trials(set.get(), 1, &outside, 1, nullptr, offsets.data()),
                 GRAINLAW_BAD_ARGUMENT, "outside");
  offsets = {0, 3};
  std::array<char, 8> bytes{};
  expect_refused(
      grainlaw_points_save_trials(set.get(), 1, nullptr, 1, bytes.data(), offsets.data()),
      GRAINLAW_BUFFER_TOO_SMALL, "too small");
  expect_refused(
      grainlaw_points_load_trials(set.get(), 1, &outside, bytes.data(), offsets.data(), nullptr, 0),
      GRAINLAW_BAD_ARGUMENT, "outside");
  expect_refused(
      grainlaw_points_load_trials(set.get(), 1, nullptr, nullptr, offsets.data(), nullptr, 0),
      GRAINLAW_NULL_POINTER, "no bytes");
}

}  // namespace
}  // namespace grainlaw::test
