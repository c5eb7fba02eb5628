// Sets of several ranks, here threads, that share their failures.
#include "ranks_support.hpp"

#include <cmath>

namespace grainlaw::test {
namespace {

Summarised evaluate_rank(Points& set, std::vector<double> F) {
  F.resize(4 * set.size());
  return evaluate_at(set, F, 1);
}

TEST(ranks, agree_on_status_ratio_and_text_of_the_first_failure) {
  on_ranks([](int rank, Points& set) {
    auto F = deformations();
    if (rank == 0) F[4 * 5] = F[4 * 5 + 3] = 1.5;
    if (rank == 1) F[4 * 2] = -1;
    const Summarised found = evaluate_rank(set, F);
    EXPECT_EQ(found.status, GRAINLAW_STEP_TOO_LARGE);
    EXPECT_EQ(found.summary.rank, 0);
    EXPECT_EQ(found.summary.first_failed, 5);
    EXPECT_EQ(found.summary.failed, 2);
    EXPECT_EQ(found.summary.step_ratio, 0.1);
    EXPECT_EQ(std::string(found.summary.message).rfind("the stretch", 0), 0U);
    EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
    if (rank == 1) F[4 * 2] = NAN;  // fatal before recoverable, though of a later rank
    const Summarised fatal = evaluate_rank(set, F);
    EXPECT_EQ(fatal.status, GRAINLAW_NOT_FINITE);
    EXPECT_EQ(fatal.summary.rank, 1);
    EXPECT_EQ(fatal.summary.first_failed, 2);
    EXPECT_EQ(std::string(fatal.summary.message).rfind("F11 is", 0), 0U);
  });
}

TEST(ranks, commit_together_or_not_at_all) {
  on_ranks([](int rank, Points& set) {
    const auto before = set.save();
    EXPECT_EQ(evaluate_rank(set, deformations()).status, GRAINLAW_OK);
    if (rank == 1) set.revert();
    EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
    EXPECT_TRUE(same_bits(set.save(), before));
    const Summarised found = evaluate_rank(set, deformations());
    EXPECT_EQ(found.status, GRAINLAW_OK);
    EXPECT_EQ(found.summary.rank, -1);
    EXPECT_STREQ(found.summary.message, "");
    EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_OK);
    EXPECT_EQ(same_bits(set.save(), before), set.size() == 0);
  });
}

// A call that one rank is refused does not leave the others waiting.
TEST(ranks, are_told_of_a_refused_call_on_one_of_them) {
  on_ranks([](int rank, Points& set) {
    const auto F = deformations();
    grainlaw_summary summary = grainlaw_summary_default();
    const unsigned want = rank == 1 ? 3 : 0;
    EXPECT_EQ(grainlaw_points_evaluate(set.get(), F.data(), want, nullptr, nullptr, nullptr,
                                       nullptr, 1, &summary),
              GRAINLAW_BAD_ARGUMENT);
    EXPECT_EQ(summary.rank, 1);
    EXPECT_EQ(summary.failed, 0);
    EXPECT_EQ(summary.first_failed, -1);
    EXPECT_STREQ(summary.message,
                 "want is 3, expected 0 or one of GRAINLAW_WANT_TANGENT_*: 1, 2 or 4");
    if (rank == 0) summary.size = 8;
    EXPECT_EQ(grainlaw_points_evaluate(set.get(), F.data(), 0, nullptr, nullptr, nullptr, nullptr,
                                       1, &summary),
              GRAINLAW_BAD_REPORT);
    EXPECT_EQ(evaluate_rank(set, deformations()).status, GRAINLAW_OK);
  });
}

TEST(ranks, agree_on_what_else_fails) {
  on_ranks([](int rank, Points& set) {
    EXPECT_NO_THROW(set.agree(GRAINLAW_OK, ""));
    const char* const texts[ranks] = {"", "no such file: a.chk", "another one"};
    try {
      set.agree(rank == 0 ? GRAINLAW_OK : GRAINLAW_FILE_ERROR, texts[rank]);
      ADD_FAILURE() << "expected an error on rank " << rank;
    } catch (const grainlaw::StatusError& error) {
      EXPECT_EQ(error.status(), GRAINLAW_FILE_ERROR);
      EXPECT_STREQ(error.what(), texts[1]);
    }
  });
}

TEST(ranks, are_told_of_a_refused_answer_of_one_of_them) {
  on_ranks([](int rank, Points& set) {
    std::vector<double> P(4 * set.size());
    grainlaw_summary summary = grainlaw_summary_default();
    const unsigned want = rank == 0 ? 3 : 0;
    EXPECT_EQ(grainlaw_points_answer(set.get(), want, P.data(), nullptr, 1, &summary),
              GRAINLAW_BAD_ARGUMENT);
    EXPECT_EQ(summary.rank, 0);
    EXPECT_EQ(grainlaw_points_answer(set.get(), 0, P.data(), nullptr, 1, &summary), GRAINLAW_OK);
  });
}

// What a host does to restart: load, agree, and on a failure of any rank go back on all.
TEST(ranks, whose_restart_fails_on_one_of_them_go_on_from_where_they_were) {
  on_ranks([](int rank, Points& set) {
    const auto checkpoint = set.save();
    EXPECT_EQ(evaluate_rank(set, deformations()).status, GRAINLAW_OK);
    set.commit();
    const auto before = set.save();
    auto bytes = checkpoint;
    if (rank == 1) bytes.resize(bytes.size() / 2);
    std::string mine, told;
    try {
      set.load(bytes);
    } catch (const grainlaw::StatusError& error) {
      mine = error.what();
    }
    EXPECT_EQ(mine.empty(), rank != 1);
    try {
      set.agree(mine.empty() ? GRAINLAW_OK : GRAINLAW_BAD_BYTES, mine);
      ADD_FAILURE() << "expected an error on rank " << rank;
    } catch (const grainlaw::StatusError& error) {
      told = error.what();
      set.load(before);
    }
    EXPECT_EQ(told, "saved points: damaged or truncated");
    EXPECT_EQ(rank == 1, told == mine);
    EXPECT_TRUE(same_bits(set.save(), before));
  });
}

TEST(ranks, of_a_copy_are_none_and_a_set_may_be_alone_again) {
  Points set = make_set();
  Allreduce nobody;
  Rank rank{&nobody, 0};
  set.share(0, Rank::reduce, &rank);
  Points copy(set);
  evaluate(copy, 1);
  copy.commit();
  EXPECT_EQ(grainlaw_points_share(set.get(), -1, Rank::reduce, &rank), GRAINLAW_BAD_ARGUMENT);
  set.share(0, nullptr, nullptr);
  evaluate(set, 1);
  set.commit();
}

}  // namespace
}  // namespace grainlaw::test
