// Marches led by hosts of a few lines: convergence, cuts, growth, jumps, and steps that are given up.
#include "ranks_support.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace grainlaw::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A march whose host tells what a test scripts.
class Scripted {
 public:
  explicit Scripted(const grainlaw_march_options& options = grainlaw_march_options_default())
      : march_(nullptr, options) {}

  void begin(double from, double to) { march_.begin(from, to); }
  // Expects this action next.
  void expect(grainlaw_action action) { EXPECT_EQ(march_.next(), action) << part().message; }
  void converges() { tells(GRAINLAW_OK, 0); }
  void tells(grainlaw_status status, double residual, double unforeseen = -1) {
    expect(GRAINLAW_SOLVE);
    march_.tell(status, residual, 1, unforeseen);
  }
  void is_refused(double ratio) {
    PointsEvaluation found;
    found.status = GRAINLAW_STEP_TOO_LARGE;
    found.summary.step_ratio = ratio;
    found.summary.failed = 1;
    found.summary.first_failed = 7;
    std::strcpy(found.summary.message, "the stretch");
    expect(GRAINLAW_SOLVE);
    march_.tell(found, nan, nan);
  }
  // Residuals that never halve, until patience ends: five of them by default.
  void stalls(int iterations = 5) {
    for (int k = 0; k < iterations; ++k) tells(GRAINLAW_OK, 1, k == 2 ? 5 : 1);
  }
  // Accepts every part; the loads of those up to the end.
  std::vector<double> loads_to_the_end() {
    std::vector<double> loads;
    for (;;) {
      const grainlaw_action action = march_.next();
      if (action == GRAINLAW_DONE) return loads;
      if (action == GRAINLAW_SOLVE) march_.tell(GRAINLAW_OK);
      if (action == GRAINLAW_ACCEPT) loads.push_back(part().load);
    }
  }
  [[nodiscard]] const grainlaw_part& part() const { return march_.part(); }
  March& march() { return march_; }

 private:
  March march_;
};

TEST(march, a_step_that_converges_is_one_part) {
  Scripted host;
  host.begin(0.5, 0.75);
  host.tells(GRAINLAW_OK, 1);
  host.tells(GRAINLAW_OK, 1e-3);
  EXPECT_EQ(host.part().load, 0.75);
  EXPECT_EQ(host.part().time, 1);
  host.tells(GRAINLAW_OK, 1e-9);
  host.expect(GRAINLAW_ACCEPT);
  EXPECT_EQ(host.part().complete, 1);
  EXPECT_EQ(host.part().solves, 3);
  EXPECT_EQ(host.part().residual, 1e-9);
  host.expect(GRAINLAW_DONE);
  host.expect(GRAINLAW_DONE);
}

TEST(march, a_refused_part_is_cut_by_its_ratio_and_parts_double_again) {
  Scripted host;
  host.begin(0, 1);
  host.is_refused(0.2);
  host.expect(GRAINLAW_BACK);
  EXPECT_STREQ(host.part().message, "point 7: the stretch");
  EXPECT_EQ(host.part().load, 1);
  const std::vector<double> expected{0.2, 0.2 + 0.4, 1};
  EXPECT_EQ(host.loads_to_the_end(), expected);
  EXPECT_EQ(host.part().cuts, 1);
}

TEST(march, cuts_stay_between_a_tenth_and_a_half) {
  for (const auto& [ratio, part] : {std::pair{0.3, 0.3}, {0.0, 0.1}, {1.0, 0.5}, {nan, 0.5}}) {
    Scripted host;
    host.begin(0, 1);
    host.is_refused(ratio);
    host.expect(GRAINLAW_BACK);
    host.expect(GRAINLAW_SOLVE);
    EXPECT_EQ(host.part().load, part) << ratio;
    EXPECT_EQ(host.part().time, part) << ratio;
    EXPECT_EQ(grainlaw_march_cut(ratio), part) << ratio;
  }
}

TEST(march, a_step_may_go_down) {
  Scripted host;
  host.begin(1, 0);
  host.is_refused(0.25);
  host.expect(GRAINLAW_BACK);
  const std::vector<double> expected{0.75, 0.25, 0};
  EXPECT_EQ(host.loads_to_the_end(), expected);
}

TEST(march, residuals_that_do_not_halve_end_an_attempt) {
  Scripted host;
  host.begin(0, 1);
  for (const double residual : {1.0, 0.4, 0.3, 0.25, 0.21, 0.2}) host.tells(GRAINLAW_OK, residual);
  host.expect(GRAINLAW_BACK);
  EXPECT_STREQ(host.part().message,
               "Newton did not converge: best relative residual 2.0e-01, expected 1.0e-08 [-]");
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.part().load, 0.5);
}

TEST(march, iterations_and_residuals_that_are_no_numbers_end_an_attempt) {
  auto options = grainlaw_march_options_default();
  options.max_iterations = 3;
  Scripted host(options);
  host.begin(0, 1);
  for (const double residual : {1.0, 0.4, 0.1}) host.tells(GRAINLAW_OK, residual);
  host.expect(GRAINLAW_BACK);
  host.tells(GRAINLAW_OK, nan);
  host.expect(GRAINLAW_BACK);
  EXPECT_STREQ(host.part().message, "the residual is not finite");
}

TEST(march, bounded_corrections_apply_the_load_before_anything_is_accepted) {
  Scripted host;
  host.begin(0, 1);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.march().share(0.4), 0.25);
  host.tells(GRAINLAW_OK, 0, 3);  // balanced, but not at the load
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.part().keep, 0);
  EXPECT_EQ(host.march().share(0.05), 1);
  host.converges();
  host.expect(GRAINLAW_ACCEPT);
}

TEST(march, a_correction_that_is_not_finite_is_a_singular_stiffness) {
  Scripted host;
  host.begin(0, 1);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.march().share(nan), 0);
  host.expect(GRAINLAW_BACK);
  EXPECT_STREQ(host.part().message, "the stiffness is singular");
}

// Leads to a part of a sixteenth of the step.
void cut_to_a_sixteenth(Scripted& host) {
  host.begin(0, 1);
  for (int k = 0; k < 4; ++k) {
    host.stalls();
    host.expect(GRAINLAW_BACK);
  }
}

TEST(march, a_jump_in_a_small_part_is_crossed_and_balanced_from_beyond) {
  Scripted host;
  cut_to_a_sixteenth(host);
  for (int k = 0; k < 5; ++k) {
    host.tells(GRAINLAW_OK, 1, k == 2 ? 5 : 1);
    EXPECT_EQ(host.part().keep, k == 1 || k == 3 ? 1 : 0) << k;  // told of the iterate before
  }
  host.expect(GRAINLAW_CROSS);
  host.march().tell(GRAINLAW_OK, 1);
  host.expect(GRAINLAW_ACCEPT);
  EXPECT_EQ(host.part().complete, 0);
  EXPECT_EQ(host.part().load, 1.0 / 16);
  host.tells(GRAINLAW_OK, 1e-2);
  EXPECT_EQ(host.part().load, 1.0 / 16);  // from beyond
  EXPECT_EQ(host.part().time, 1.0 / 16);
  host.converges();
  host.expect(GRAINLAW_ACCEPT);
  EXPECT_EQ(host.part().crossed, 1);
  EXPECT_EQ(host.part().loose, 0);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.part().load, 3.0 / 16);
}

// Leads a part of a sixteenth of the step beyond nine jumps, where the residual is this.
void cross_nine_jumps(Scripted& host, double residual) {
  cut_to_a_sixteenth(host);
  for (int crossing = 0; crossing < 9; ++crossing) {
    if (crossing > 0) host.expect(GRAINLAW_ACCEPT);
    host.stalls();
    host.expect(GRAINLAW_CROSS);
    host.march().tell(GRAINLAW_OK, residual);
  }
}

TEST(march, after_eight_jumps_a_part_is_accepted_as_loose) {
  Scripted host;
  cross_nine_jumps(host, 1);
  host.expect(GRAINLAW_ACCEPT);
  EXPECT_EQ(host.part().crossed, 8);
  EXPECT_EQ(host.part().loose, 1);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.part().load, 3.0 / 16);
}

TEST(march, what_is_refused_beyond_a_jump_is_cut) {
  Scripted host;
  cut_to_a_sixteenth(host);
  host.stalls();
  host.expect(GRAINLAW_CROSS);
  host.march().tell(GRAINLAW_NOT_CONVERGED);
  host.expect(GRAINLAW_BACK);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.part().load, 1.0 / 32);
}

// Leads beyond the jump of a part of a sixteenth of the step.
void cross_in_a_sixteenth(Scripted& host) {
  cut_to_a_sixteenth(host);
  host.stalls();
  host.expect(GRAINLAW_CROSS);
  host.march().tell(GRAINLAW_OK, 1);
  host.expect(GRAINLAW_ACCEPT);
}

// The load is there: no correction has to be whole.
TEST(march, beyond_a_jump_bounded_iterates_are_kept_too) {
  Scripted host;
  cross_in_a_sixteenth(host);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.march().share(0.4), 0.25);
  host.tells(GRAINLAW_OK, 1, 5);
  host.expect(GRAINLAW_SOLVE);
  EXPECT_EQ(host.part().keep, 1);
}

// Shorter parts would go back from there.
TEST(march, what_fails_beyond_a_jump_is_left_there_and_the_step_goes_on) {
  Scripted host;
  cross_in_a_sixteenth(host);
  host.is_refused(0.5);
  host.expect(GRAINLAW_BACK);
  EXPECT_STREQ(host.part().message, "point 7: the stretch");
  EXPECT_EQ(host.part().loose, 1);
  EXPECT_EQ(host.part().cuts, 4);
  host.is_refused(0.5);
  EXPECT_EQ(host.part().load, 3.0 / 16);
  EXPECT_EQ(host.part().time, 2.0 / 16);
  host.expect(GRAINLAW_BACK);
  host.converges();
  EXPECT_EQ(host.part().load, 2.0 / 16);
}

TEST(march, a_step_may_end_beyond_a_jump_out_of_balance) {
  auto options = grainlaw_march_options_default();
  options.crossing_part = 1;
  Scripted host(options);
  host.begin(0, 1);
  host.stalls();
  host.expect(GRAINLAW_CROSS);
  host.march().tell(GRAINLAW_OK, 1);
  host.expect(GRAINLAW_ACCEPT);
  host.is_refused(0.5);
  host.expect(GRAINLAW_BACK);
  host.expect(GRAINLAW_DONE);
  EXPECT_EQ(host.part().loose, 1);
}

// What carries nothing of its load is no state to go on from.
TEST(march, a_step_does_not_go_on_beyond_a_jump_where_forces_are_lost) {
  Scripted host;
  cross_nine_jumps(host, 1e6);
  host.expect(GRAINLAW_GIVE_UP);
  EXPECT_NE(std::strstr(host.part().message,
                        "beyond a jump the relative residual is 1.0e+06, expected at most 1 [-]"),
            nullptr)
      << host.part().message;
  EXPECT_EQ(host.part().loose, 0);
}

TEST(march, what_is_refused_beyond_such_a_jump_ends_the_step) {
  Scripted host;
  cut_to_a_sixteenth(host);
  host.stalls();
  host.expect(GRAINLAW_CROSS);
  host.march().tell(GRAINLAW_OK, 1.5);
  host.expect(GRAINLAW_ACCEPT);
  host.is_refused(0.5);
  host.expect(GRAINLAW_GIVE_UP);
  EXPECT_NE(std::strstr(host.part().message, "the stretch"), nullptr) << host.part().message;
}

// No part is cut for it, no jump is sought: rounding is the same in all.
TEST(march, a_tolerance_below_rounding_is_told_at_once) {
  auto options = grainlaw_march_options_default();
  options.tolerance = 1e-14;
  options.crossing_part = 1;
  Scripted host(options);
  host.begin(0, 1);
  for (const double residual : {1e-2, 1e-7, 3e-14, 5e-14, 4e-14, 5e-14, 6e-14})
    host.tells(GRAINLAW_OK, residual, 1);
  host.expect(GRAINLAW_GIVE_UP);
  EXPECT_STREQ(
      host.part().message,
      "0 % along, in parts of 1.0e+00 of it too: the tolerance is below rounding: residual "
      "3.0e-14, expected 1.0e-14 [-]; ask for 1e-12");
  EXPECT_EQ(host.part().solves, 7);
}

TEST(march, jumps_that_are_unknown_or_not_wanted_are_not_crossed) {
  auto options = grainlaw_march_options_default();
  options.max_crossings = 0;
  Scripted host(options);
  cut_to_a_sixteenth(host);
  host.stalls();
  host.expect(GRAINLAW_BACK);
  Scripted unaware;
  cut_to_a_sixteenth(unaware);
  for (int k = 0; k < 5; ++k) unaware.tells(GRAINLAW_OK, 1);
  unaware.expect(GRAINLAW_BACK);
}

TEST(march, a_step_that_fails_in_its_smallest_part_is_given_up) {
  auto options = grainlaw_march_options_default();
  options.max_cuts = 3;
  Scripted host(options);
  host.begin(0, 2);
  host.is_refused(0.5);
  host.expect(GRAINLAW_BACK);
  host.converges();
  host.expect(GRAINLAW_ACCEPT);
  for (int cut = 0; cut < 2; ++cut) {
    host.is_refused(0.5);
    host.expect(GRAINLAW_BACK);
  }
  host.is_refused(0.5);
  host.expect(GRAINLAW_GIVE_UP);
  EXPECT_STREQ(host.part().message,
               "50 % along, in parts of 1.2e-01 of it too: point 7: the stretch");
  host.expect(GRAINLAW_GIVE_UP);
  host.begin(1, 2);  // a host may go on
  EXPECT_EQ(host.loads_to_the_end(), std::vector<double>{2});
}

TEST(march, loads_that_act_from_the_start_cannot_be_cut) {
  Scripted host;
  host.begin(0, 0);
  host.converges();
  host.expect(GRAINLAW_ACCEPT);
  EXPECT_EQ(host.part().time, 1);
  EXPECT_EQ(host.part().complete, 1);
  host.begin(0, 0);
  host.is_refused(0.5);
  host.expect(GRAINLAW_GIVE_UP);
  EXPECT_STREQ(host.part().message, "point 7: the stretch");
}

// Once per attempt: 0 is an equilibrium.
TEST(march, a_host_whose_own_solver_iterates_tells_once) {
  Scripted host;
  host.begin(0, 1);
  host.tells(GRAINLAW_NOT_CONVERGED, 0);
  host.expect(GRAINLAW_BACK);
  const std::vector<double> expected{0.5, 1};
  EXPECT_EQ(host.loads_to_the_end(), expected);
}

// A spring whose force jumps up for good where it is first stretched to 1.
struct Spring {
  double u = 0, committed = 0, farthest = 0;
  bool beyond = false;
  [[nodiscard]] double force() const { return u + (beyond || u > 1 ? 1 : 0); }
  void commit() { committed = u, beyond = beyond || u > 1; }
};

TEST(march, a_host_of_twenty_lines_crosses_a_jump_of_its_force) {
  Spring spring;
  March march;
  for (int step = 0; step < 2; ++step) {
    march.begin(step, step + 1);
    for (;;) {
      const grainlaw_action now = march.next();
      if (now == GRAINLAW_DONE) break;
      if (march.part().keep) spring.farthest = spring.u;
      ASSERT_NE(now, GRAINLAW_GIVE_UP) << march.part().message;
      const double load = 0.9 * march.part().load;
      const double force = spring.beyond ? spring.committed + 1 : spring.committed;
      if (now == GRAINLAW_SOLVE) spring.u += load - spring.force();
      if (now == GRAINLAW_CROSS) spring.u = spring.farthest;
      if (now == GRAINLAW_SOLVE || now == GRAINLAW_CROSS)
        march.tell(GRAINLAW_OK, std::abs(load - spring.force()), 1,
                   std::abs(spring.force() - force - (spring.u - spring.committed)));
      if (now == GRAINLAW_ACCEPT) spring.commit();
      if (now == GRAINLAW_BACK) spring.u = spring.committed;
    }
  }
  EXPECT_EQ(march.part().crossed, 1);
  EXPECT_EQ(march.part().loose, 0);
  EXPECT_NEAR(spring.force(), 1.8, 1e-8);
}

// A law in time that is told no time refuses to deform.
TEST(march, tells_its_set_the_time_of_each_part) {
  const Material in_time = Material::parse(
      read_text(material_path) + "\n[solver]\nviscous_number = 1e-3\nviscous_rate = 5e-4\n",
      data_directory);
  const auto stress_after = [&](double step_time, const auto& tell_time) {
    Points set(in_time, 1);
    auto options = grainlaw_march_options_default();
    options.step_time = step_time;
    March march(&set, options);
    march.begin(0, 1);
    march.next();
    march.tell(GRAINLAW_NOT_CONVERGED);
    march.next();
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    tell_time(set);
    std::vector<double> P(4);
    EXPECT_TRUE(set.evaluate(compressed, P));
    return P;
  };
  const auto by_march = stress_after(6, [](Points&) {});
  EXPECT_EQ(by_march, stress_after(1, [](Points& set) { set.set_time_step(3); }));
  EXPECT_NE(by_march, stress_after(1, [](Points&) {}));
}

// Without a host's own measure, by stresses that the committed tangents do not explain.
TEST(march, takes_from_its_set_how_far_an_iterate_is) {
  Points set = make_set();
  March march(&set);
  march.begin(0, 1);
  const auto keeps = [&](double share) {
    std::vector<double> F = deformations();
    for (std::size_t k = 0; k < F.size(); ++k) {
      const double at_start = k % 4 % 3 == 0 ? 1 : 0;
      F[k] = at_start + share * (F[k] - at_start);
    }
    Result found;
    const auto evaluated = set.evaluate(F, found.P, GRAINLAW_WANT_TANGENT_EXACT, found.A);
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    march.tell(evaluated, 1, 1);
    march.next();
    return march.part().keep == 1;
  };
  EXPECT_FALSE(keeps(0));  // no tangent was committed
  set.commit();
  EXPECT_TRUE(keeps(0.5));
  EXPECT_TRUE(keeps(1));
  EXPECT_FALSE(keeps(0.8));
}

TEST(march, ranks_decide_alike_by_the_norms_of_all) {
  on_ranks([](int rank, Points& set) {
    March march(&set);
    march.begin(0, 1);
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    EXPECT_EQ(march.share(rank == 2 ? 0.4 : 0.01), 0.25);
    march.tell(GRAINLAW_OK, rank == 0 ? 3 : 0, rank == 1 ? 5 : 0, rank == 1 ? 1 : 0);
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    EXPECT_EQ(march.part().residual, 0.6);
    EXPECT_EQ(march.share(0.01), 1);
    if (rank == 2)
      march.tell(GRAINLAW_NOT_CONVERGED);
    else
      march.tell(GRAINLAW_OK, 0, 1);
    EXPECT_EQ(march.next(), GRAINLAW_BACK);
    EXPECT_STREQ(march.part().message, grainlaw_status_text(GRAINLAW_NOT_CONVERGED));
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    EXPECT_EQ(march.part().load, 0.5);
    EXPECT_EQ(march.share(rank == 1 ? nan : 0.01), 0);
    EXPECT_EQ(march.next(), GRAINLAW_BACK);
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    march.tell(GRAINLAW_OK, 0, 1);
    EXPECT_EQ(march.next(), GRAINLAW_ACCEPT);
    EXPECT_EQ(march.part().load, 0.25);
  });
}

TEST(march, ranks_cut_together_where_the_points_of_one_refuse) {
  on_ranks([](int rank, Points& set) {
    March march(&set);
    march.begin(0, 1);
    std::vector<double> loads;
    for (grainlaw_action now; (now = march.next()) != GRAINLAW_DONE;) {
      if (now == GRAINLAW_SOLVE) {
        const double shortened = 1 - (rank == 0 ? 0.33 : 1e-4) * march.part().load;
        std::vector<double> F, P(4 * set.size());
        for (std::size_t k = 0; k < set.size(); ++k) F.insert(F.end(), {1, 0, 0, shortened});
        march.tell(set.evaluate(F, P), 0, 1);
      }
      ASSERT_NE(now, GRAINLAW_GIVE_UP);
      if (now == GRAINLAW_ACCEPT) set.commit(), loads.push_back(march.part().load);
      if (now == GRAINLAW_BACK) set.revert();
      if (now == GRAINLAW_BACK) {
        EXPECT_EQ(std::string(march.part().message).rfind("rank 0, point 0: ", 0), 0U);
      }
    }
    EXPECT_GT(march.part().cuts, 0);
    EXPECT_EQ(loads.back(), 1);
  });
}

TEST(march, ranks_go_back_together_where_the_evaluation_of_one_is_an_error) {
  on_ranks([](int rank, Points& set) {
    const auto before = set.save();
    March march(&set);
    march.begin(0, 1);
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    auto F = deformations();
    if (rank == 0) F[3] = nan;
    F.resize(4 * set.size());
    const Summarised found = evaluate_at(set, F, 1);
    EXPECT_EQ(grainlaw_march_tell(march.get(), found.status, &found.summary, 0, 1, -1),
              GRAINLAW_OK);
    EXPECT_EQ(march.next(), GRAINLAW_BACK);
    EXPECT_EQ(std::string(march.part().message).rfind("rank 0, point 0: F22 is", 0), 0U)
        << march.part().message;
    set.revert();
    EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
    EXPECT_TRUE(same_bits(set.save(), before));
    EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
    EXPECT_EQ(march.part().load, 0.1);
  });
}

TEST(bad_march, arguments_are_refused) {
  grainlaw_march* march = nullptr;
  const auto refuses = [&](const char* what, auto change) {
    auto options = grainlaw_march_options_default();
    change(options);
    march = reinterpret_cast<grainlaw_march*>(&march);
    expect_refused(grainlaw_march_create(&options, nullptr, &march), GRAINLAW_BAD_ARGUMENT, what);
    EXPECT_EQ(march, nullptr) << what;
  };
  using Options = grainlaw_march_options;
  refuses("tolerance 0", [](Options& o) { o.tolerance = 0; });
  refuses("tolerance NaN", [](Options& o) { o.tolerance = nan; });
  refuses("no iterations", [](Options& o) { o.max_iterations = 0; });
  refuses("cuts < 0", [](Options& o) { o.max_cuts = -1; });
  refuses("cuts below the smallest number", [](Options& o) { o.max_cuts = 1001; });
  refuses("no patience", [](Options& o) { o.patience = 0; });
  refuses("correction < 0", [](Options& o) { o.largest_correction = -1; });
  refuses("crossing part NaN", [](Options& o) { o.crossing_part = nan; });
  refuses("crossings < 0", [](Options& o) { o.max_crossings = -1; });
  refuses("step time < 0", [](Options& o) { o.step_time = -1; });
  auto options = grainlaw_march_options_default();
  options.size = 8;
  expect_refused(grainlaw_march_create(&options, nullptr, &march), GRAINLAW_BAD_REPORT, "size");
  expect_refused(grainlaw_march_create(nullptr, nullptr, nullptr), GRAINLAW_NULL_POINTER, "out");
  March whole;
  expect_refused(
      grainlaw_march_create(nullptr, reinterpret_cast<grainlaw_points*>(whole.get()), &march),
      GRAINLAW_BAD_HANDLE, "a set that is none");
  expect_refused(grainlaw_march_begin(nullptr, 0, 1), GRAINLAW_NULL_POINTER, "begin");
  expect_refused(grainlaw_march_begin(whole.get(), 0, nan), GRAINLAW_BAD_ARGUMENT, "to NaN");
  expect_refused(grainlaw_march_begin(whole.get(), -1e308, 1e308), GRAINLAW_BAD_ARGUMENT, "far");
  expect_refused(grainlaw_march_tell(nullptr, GRAINLAW_OK, nullptr, 0, 1, 0), GRAINLAW_NULL_POINTER,
                 "tell");
}

TEST(bad_march, calls_out_of_turn_are_refused) {
  EXPECT_EQ(grainlaw_march_next(nullptr, nullptr), GRAINLAW_GIVE_UP);
  EXPECT_EQ(grainlaw_march_share(nullptr, 1), 0);
  March march;
  EXPECT_EQ(march.next(), GRAINLAW_GIVE_UP);  // before any load step
  const auto tell = [&] { return grainlaw_march_tell(march.get(), GRAINLAW_OK, nullptr, 0, 1, 0); };
  march.begin(0, 1);
  expect_refused(tell(), GRAINLAW_BAD_ARGUMENT, "before it is asked");
  EXPECT_EQ(march.share(0.1), 0);
  grainlaw_part part = grainlaw_part_default();
  part.size = 8;
  EXPECT_EQ(grainlaw_march_next(march.get(), &part), GRAINLAW_GIVE_UP);
  EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
  EXPECT_EQ(march.next(), GRAINLAW_SOLVE);
  grainlaw_summary summary = grainlaw_summary_default();
  summary.size = 8;
  expect_refused(grainlaw_march_tell(march.get(), GRAINLAW_OK, &summary, 0, 1, 0),
                 GRAINLAW_BAD_REPORT, "summary");
  EXPECT_EQ(tell(), GRAINLAW_OK);
  expect_refused(tell(), GRAINLAW_BAD_ARGUMENT, "twice");
  EXPECT_EQ(march.next(), GRAINLAW_ACCEPT);
  expect_refused(tell(), GRAINLAW_BAD_ARGUMENT, "nothing was asked");
}

}  // namespace
}  // namespace grainlaw::test
