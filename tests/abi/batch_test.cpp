// Many points at once.
#include "batch_support.hpp"

#include <cmath>
#include <cstdint>

namespace grainlaw::test {
namespace {

TEST(batch, results_do_not_depend_on_the_number_of_threads) {
  const auto F = deformations();
  Result expected;
  auto single = states();
  for (std::size_t k = 0; k < points; ++k)
    ASSERT_EQ(grainlaw_evaluate(single[k].get(), &F[4 * k], GRAINLAW_WANT_TANGENT_EXACT,
                                &expected.P[4 * k], &expected.A[16 * k], &expected.report[k]),
              GRAINLAW_OK);
  for (const int threads : {1, 2, 4, 8, 0}) {
    auto many = states();
    const auto all = handles(many);
    for (int round = 0; round < 2; ++round) {  // the second one ordered by cost
      Result found;
      ASSERT_EQ(grainlaw_evaluate_batch(points, all.data(), F.data(), GRAINLAW_WANT_TANGENT_EXACT,
                                        found.P.data(), found.A.data(), found.status.data(),
                                        found.report.data(), threads),
                GRAINLAW_OK);
      EXPECT_TRUE(same_bits(expected.P, found.P)) << threads << " threads";
      EXPECT_TRUE(same_bits(expected.A, found.A)) << threads << " threads";
      for (std::size_t k = 0; k < points; ++k)
        EXPECT_EQ(expected.report[k].relaxation_steps, found.report[k].relaxation_steps);
    }
    for (std::size_t k = 0; k < points; ++k) {
      many[k].commit();
      if (threads == 1) single[k].commit();
      EXPECT_TRUE(same_bits(single[k].save(), many[k].save()));
    }
  }
}

TEST(batch, one_bad_point_leaves_the_others) {
  auto F = deformations();
  F[4 * 2] = -1;  // inverted
  F[4 * 5 + 1] = NAN;
  auto many = states();
  const auto all = handles(many);
  Result found;
  EXPECT_EQ(grainlaw_evaluate_batch(points, all.data(), F.data(), 0, found.P.data(), nullptr,
                                    found.status.data(), found.report.data(), 2),
            GRAINLAW_NOT_FINITE);  // fatal before recoverable
  for (std::size_t k = 0; k < points; ++k) {
    const auto expected = k == 2 ? GRAINLAW_INVERTED : k == 5 ? GRAINLAW_NOT_FINITE : GRAINLAW_OK;
    EXPECT_EQ(found.status[k], expected);
    EXPECT_EQ(std::string(found.report[k].message).empty(), expected == GRAINLAW_OK);
    EXPECT_EQ(grainlaw_commit(all[k]), expected == GRAINLAW_OK ? GRAINLAW_OK : GRAINLAW_NO_TRIAL);
  }
}

TEST(batch, of_no_points_is_done) {
  EXPECT_EQ(grainlaw_evaluate_batch(0, nullptr, nullptr, 0, nullptr, nullptr, nullptr, nullptr, 1),
            GRAINLAW_OK);
}

TEST(bad_batch, is_refused_before_any_point_is_touched) {
  const auto F = deformations();
  auto many = states();
  auto all = handles(many);
  Result found;
  const auto refused = [&](grainlaw_status expected, const std::string& what) {
    const auto status =
        grainlaw_evaluate_batch(points, all.data(), F.data(), 0, found.P.data(), nullptr,
                                found.status.data(), found.report.data(), 1);
    expect_refused(status, expected, what);
    EXPECT_EQ(found.status, std::vector(points, expected)) << what;
    for (const State& state : many) EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
  };
  all[6] = all[1];
  refused(GRAINLAW_BAD_ARGUMENT, "a state twice");
  all[6] = nullptr;
  refused(GRAINLAW_NULL_POINTER, "a null state");
  std::array<std::uint64_t, 64> rubbish{};
  all[6] = reinterpret_cast<grainlaw_state*>(rubbish.data());
  refused(GRAINLAW_BAD_HANDLE, "a dead state");
  all[6] = many[6].get();
  found.report[3].size = 8;
  refused(GRAINLAW_BAD_REPORT, "a report of another size");
  found.report[3].size = sizeof(grainlaw_report);
  found.report[0].size = 0;
  refused(GRAINLAW_BAD_REPORT, "a first report of unknown size");

  const auto call = [&](grainlaw_state* const* states, const double* deformation, unsigned want,
                        grainlaw_status* status) {
    return grainlaw_evaluate_batch(points, states, deformation, want, nullptr, nullptr, status,
                                   nullptr, 1);
  };
  auto* const status = found.status.data();
  expect_refused(call(nullptr, F.data(), 0, status), GRAINLAW_NULL_POINTER, "states");
  expect_refused(call(all.data(), nullptr, 0, status), GRAINLAW_NULL_POINTER, "F");
  expect_refused(call(all.data(), F.data(), 0, nullptr), GRAINLAW_NULL_POINTER, "status");
  for (const unsigned want : {3U, 5U, 6U, 7U, 8U, ~0U})
    expect_refused(call(all.data(), F.data(), want, status), GRAINLAW_BAD_ARGUMENT, "want");
}

}  // namespace
}  // namespace grainlaw::test
