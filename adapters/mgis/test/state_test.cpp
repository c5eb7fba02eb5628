// States named by two internal variables: what is retried, what is accepted, what is lost. With a
// packing of 40 discs, made for these tests.
#include "mgis_host.hpp"

#include <grainlaw/grainlaw.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

namespace grainlaw::test {
namespace {

using F2 = std::array<double, 4>;
constexpr F2 path[] = {{0.9996, 0.0003, -0.0001, 1.0002},
                       {0.9990, 0.0012, -0.0004, 1.0005},
                       {0.9982, 0.0024, -0.0009, 1.0010}};
constexpr F2 elsewhere{1.0005, -0.0010, 0.0002, 0.9990};

const std::string behaviours = GRAINLAW_BEHAVIOURS;

grainlaw::State direct_state() {
  static const grainlaw::Material material =
      grainlaw::Material::load(std::string(GRAINLAW_BEHAVIOURS) + "/../small.toml");
  return grainlaw::State(material);
}

F2 direct(grainlaw::State& state, const F2& F) {
  F2 P{};
  EXPECT_TRUE(state.evaluate(F, P));
  return P;
}

class mgis_state : public testing::Test {
 protected:
  BehaviourLibrary library{behaviours + "/libSmall.so"};

  Manager manager(std::size_t points = 1) const {
    return {library, "Small", "PlaneStrain", points, first_piola, dP_dF};
  }
  std::size_t states() const { return library.symbol<std::size_t()>("Small_states")(); }

  static F2 evaluate(Manager& host, const F2& F, std::size_t point = 0) {
    host.set_F(point, F);
    EXPECT_EQ(host.integrate(point), 1) << host.message;
    const double* P = &host.s1.forces[point * host.stress_size];
    return {P[0], P[3], P[4], P[1]};
  }
};

TEST_F(mgis_state, retries_and_accepted_steps_are_those_of_a_host_that_says_commit) {
  Manager host = manager();
  grainlaw::State state = direct_state();
  for (const F2& F : path) {
    evaluate(host, elsewhere);
    evaluate(host, F);
    evaluate(host, elsewhere);
    EXPECT_EQ(evaluate(host, F), direct(state, F));
    host.update();
    state.commit();
  }
}

TEST_F(mgis_state, revert_goes_back_to_the_start_of_the_step) {
  Manager host = manager();
  grainlaw::State state = direct_state();
  for (const F2& F : path) {
    evaluate(host, elsewhere);
    host.revert();
    EXPECT_EQ(evaluate(host, F), direct(state, F));
    host.update();
    state.commit();
    host.revert();
  }
}

TEST_F(mgis_state, an_accepted_answer_that_was_not_the_last_is_found_again) {
  Manager host = manager();
  grainlaw::State state = direct_state();
  evaluate(host, path[0]);
  const Manager::State accepted = host.s1;
  evaluate(host, elsewhere);
  host.s0 = accepted;
  direct(state, path[0]);
  state.commit();
  EXPECT_EQ(evaluate(host, path[1]), direct(state, path[1]));
}

TEST_F(mgis_state, a_failed_step_leaves_the_host_and_the_state_alone) {
  Manager host = manager();
  grainlaw::State state = direct_state();
  evaluate(host, path[0]);
  host.update();
  direct(state, path[0]);
  state.commit();
  const Manager::State before = host.s1;
  host.set_F(0, {1.6, 0, 0, 1});
  EXPECT_EQ(host.integrate(0), -1);
  EXPECT_EQ(host.rdt, 0.1);
  EXPECT_NE(host.message.find("smaller step"), std::string::npos) << host.message;
  EXPECT_EQ(host.s1.forces, before.forces);
  EXPECT_EQ(host.s1.internal, before.internal);
  EXPECT_EQ(evaluate(host, path[1]), direct(state, path[1]));
}

TEST_F(mgis_state, an_approximate_answer_is_given_and_half_the_step_asked_for) {
  const BehaviourLibrary advancing{behaviours + "/libAdvancing.so"};
  Manager host(advancing, "Advancing", "PlaneStrain", 1, first_piola, dP_dF);
  grainlaw::State state(grainlaw::Material::load(behaviours + "/../advancing.toml"));
  for (const F2& F : {path[0], path[1]}) {
    host.set_F(0, F);
    EXPECT_EQ(host.integrate(0), 0);
    EXPECT_EQ(host.rdt, 0.5);
    EXPECT_EQ(host.message,
              "the equilibrium was only found by advancing the friction history; approximate");
    const double* P = host.s1.forces.data();
    EXPECT_EQ((F2{P[0], P[3], P[4], P[1]}), direct(state, F));
    state.commit();
    host.update();
  }
  double step = 0.25;  // a shorter one that the host has in mind stays
  host.set_F(0, path[2]);
  EXPECT_EQ(host.call(0, consistent, nullptr, &step), 0);
  EXPECT_EQ(step, 0.25);
}

TEST_F(mgis_state, a_step_that_was_cut_ends_like_the_same_steps_uncut) {
  constexpr double target = 0.7;  // simple shear; more than the library takes at once
  const BehaviourLibrary bonded{behaviours + "/libBonded.so"};
  const auto made = [&] { return Manager(bonded, "Bonded", "PlaneStrain", 1, first_piola, dP_dF); };
  Manager host = made();
  std::vector<double> shears;
  double shear = 0, step = target;
  int cuts = 0;
  while (shear < target - 1e-9) {
    const double next = std::min(shear + step, target);
    host.set_F(0, {1, next, 0, 1});
    if (host.integrate(0, no_tangent) < 0) {
      ASSERT_LT(host.rdt, 1) << host.message;
      step *= host.rdt;
      host.revert();
      ASSERT_LT(++cuts, 10);
      continue;
    }
    shears.push_back(shear = next);
    host.update();
  }
  EXPECT_GE(cuts, 1);
  Manager uncut = made();
  for (const double s : shears) {
    uncut.set_F(0, {1, s, 0, 1});
    ASSERT_GE(uncut.integrate(0, no_tangent), 0);
    uncut.update();
  }
  EXPECT_EQ(host.s0.forces, uncut.s0.forces);
}

TEST_F(mgis_state, a_prediction_gives_the_tangent_at_the_start_and_changes_nothing) {
  Manager host = manager();
  Manager plain = manager();
  evaluate(host, path[0]);
  evaluate(plain, path[0]);
  const std::vector<double> internal = host.s1.internal;
  for (const double request : {-1.0, -2.0, -3.0}) {
    host.K.assign(host.K.size(), 0);
    EXPECT_EQ(host.integrate(0, request), 1) << host.message;
    EXPECT_NE(host.K[0], 0);
  }
  host.update();
  plain.update();
  for (const double request : {-1.0, -3.0}) {
    EXPECT_EQ(host.integrate(0, request), 1) << host.message;
    EXPECT_GT(host.K[0], 1e6);
  }
  EXPECT_EQ(host.s1.internal, internal);
  EXPECT_EQ(evaluate(host, path[1]), evaluate(plain, path[1]));
}

TEST_F(mgis_state, points_in_threads_give_the_bits_of_one_thread) {
  constexpr std::size_t points = 8;
  const auto run = [&](std::size_t threads) {
    Manager host = manager(points);
    for (const F2& F : path) {
      std::vector<std::thread> pool;
      for (std::size_t t = 0; t < threads; ++t) {
        pool.emplace_back([&, t] {
          for (std::size_t p = t; p < points; p += threads) {
            F2 own = F;
            own[0] -= 1e-5 * static_cast<double>(p);
            host.set_F(p, own);
            std::array<char, 512> text{};
            double rdt = 1;
            EXPECT_EQ(host.call(p, consistent, text.data(), &rdt), 1) << text.data();
          }
        });
      }
      for (std::thread& thread : pool) thread.join();
      host.update();
    }
    return host.s1.forces;
  };
  const auto alone = run(1);
  EXPECT_EQ(run(4), alone);
  EXPECT_EQ(run(8), alone);
}

TEST_F(mgis_state, first_increments_are_not_kept_before_they_are_accepted) {
  constexpr std::size_t points = 4;
  Manager host = manager(points);
  const auto sweep = [&](const F2& F) {
    for (std::size_t p = 0; p < points; ++p) {
      host.set_F(p, F);
      ASSERT_EQ(host.integrate(p, no_tangent), 1) << host.message;
    }
  };
  for (int iteration = 0; iteration < 5; ++iteration) {
    sweep(path[0]);
    if (iteration == 2) host.revert();
  }
  EXPECT_EQ(states(), 0u);
  host.update();
  for (int iteration = 0; iteration < 3; ++iteration) sweep(path[1]);
  EXPECT_EQ(states(), points);
}

TEST_F(mgis_state, a_first_increment_is_found_again_where_it_is_accepted) {
  Manager host = manager(3);
  for (const F2& F : {elsewhere, path[0]}) {
    for (std::size_t p = 0; p < 3; ++p) evaluate(host, F, p);
  }
  EXPECT_EQ(states(), 0u);
  host.update();
  grainlaw::State state = direct_state();
  direct(state, path[0]);
  state.commit();
  const F2 expected = direct(state, path[1]);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ(evaluate(host, path[1], p), expected);
  EXPECT_EQ(states(), 3u);
}

TEST_F(mgis_state, states_of_analyses_that_ended_stay_within_the_budget) {
  setenv("GRAINLAW_IDLE_MEMORY", "0.1", 1);  // MiB: some 15 states of 40 discs
  constexpr std::size_t points = 4;
  std::size_t most_early = 0, most_late = 0;
  for (int analysis = 0; analysis < 40; ++analysis) {
    Manager host = manager(points);
    for (int step = 0; step < 3; ++step) {
      for (int iteration = 0; iteration < 8; ++iteration) {
        for (std::size_t p = 0; p < points; ++p) evaluate(host, path[step], p);
      }
      host.update();
    }
    std::size_t& most = analysis < 12 ? most_early : most_late;
    most = std::max(most, states());
  }
  EXPECT_LE(most_early, 60u);
  EXPECT_LE(most_late, most_early);
  unsetenv("GRAINLAW_IDLE_MEMORY");
}

TEST_F(mgis_state, a_released_behaviour_starts_anew) {
  Manager host = manager();
  const F2 P = evaluate(host, path[0]);
  library.symbol<void()>("Small_release")();
  EXPECT_EQ(states(), 0u);
  Manager again = manager();
  EXPECT_EQ(evaluate(again, path[0]), P);
}

}  // namespace
}  // namespace grainlaw::test
