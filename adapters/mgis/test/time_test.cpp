// Laws in time: the time step that the host hands over.
#include "mgis_host.hpp"

#include <grainlaw/grainlaw.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainlaw::test {
namespace {

using F2 = std::array<double, 4>;
constexpr F2 path[] = {{0.9996, 0.0003, -0.0001, 1.0002},
                       {0.9990, 0.0012, -0.0004, 1.0005},
                       {0.9982, 0.0024, -0.0009, 1.0010}};
constexpr F2 unit{1, 0, 0, 1};

grainlaw::State direct_state(const std::string& file) {
  return grainlaw::State(
      grainlaw::Material::load(std::string(GRAINLAW_BEHAVIOURS) + "/../" + file));
}

F2 direct(grainlaw::State& state, const F2& F, double time_step) {
  F2 P{};
  state.set_time_step(time_step);
  EXPECT_TRUE(state.evaluate(F, P));
  return P;
}

class mgis_time : public testing::Test {
 protected:
  BehaviourLibrary library{std::string(GRAINLAW_BEHAVIOURS) + "/libSmallInTime.so"};

  Manager manager(std::size_t points = 1) const {
    return {library, "SmallInTime", "PlaneStrain", points, first_piola, dP_dF};
  }
  static F2 evaluate(Manager& host, const F2& F, double dt, std::size_t point = 0) {
    host.set_F(point, F);
    host.dt = dt;
    EXPECT_EQ(host.integrate(point), 1) << host.message;
    const double* P = &host.s1.forces[point * host.stress_size];
    return {P[0], P[3], P[4], P[1]};
  }
};

TEST_F(mgis_time, is_that_of_the_step) {
  Manager host = manager();
  grainlaw::State state = direct_state("small_in_time.toml");
  double dt = 0.5;
  for (const F2& F : path) {
    evaluate(host, F, 4 * dt);  // a try that the host cuts
    EXPECT_EQ(evaluate(host, F, dt), direct(state, F, dt));
    host.update();
    state.commit();
    dt *= 2;
  }
}

TEST_F(mgis_time, is_asked_for_before_the_packing_deforms) {
  Manager host = manager();
  for (const double none : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    host.dt = none;
    host.set_F(0, path[0]);
    const Manager::State before = host.s1;
    EXPECT_EQ(host.integrate(0), -1);
    EXPECT_NE(host.message.find("viscous_rate"), std::string::npos) << host.message;
    EXPECT_EQ(host.rdt, 1);  // no smaller step helps
    EXPECT_EQ(host.s1.forces, before.forces);
    EXPECT_EQ(host.s1.internal, before.internal);
  }
}

TEST_F(mgis_time, of_nothing_is_for_an_increment_of_nothing) {
  Manager host = manager();
  grainlaw::State state = direct_state("small_in_time.toml");
  evaluate(host, unit, 0);
  host.update();
  state.set_time_step(0);
  F2 P{};
  ASSERT_TRUE(state.evaluate(unit, P));
  state.commit();
  EXPECT_EQ(evaluate(host, path[0], 1e-12), direct(state, path[0], 1e-12));
  host.update();
  state.commit();
  EXPECT_EQ(evaluate(host, path[1], 1), direct(state, path[1], 1));
}

TEST_F(mgis_time, of_a_first_increment_is_found_again_where_it_is_accepted) {
  Manager host = manager(3);
  for (const double dt : {2.0, 0.5}) {
    for (std::size_t p = 0; p < 3; ++p) evaluate(host, path[0], dt, p);
  }
  host.update();
  grainlaw::State state = direct_state("small_in_time.toml");
  direct(state, path[0], 0.5);
  state.commit();
  const F2 expected = direct(state, path[1], 1);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ(evaluate(host, path[1], 1, p), expected);
}

// Drag does not hide the moments of discs that do not turn.
TEST(mgis_moments_in_time, of_locked_discs_are_refused) {
  const BehaviourLibrary library(std::string(GRAINLAW_BEHAVIOURS) + "/libLockedInTime.so");
  Manager host(library, "LockedInTime", "PlaneStrain", 1, cauchy, dsigma_dF);
  host.set_F(0, {1, 1e-3, 0, 1});
  EXPECT_EQ(host.integrate(0), -1);
  EXPECT_NE(host.message.find("not symmetric"), std::string::npos) << host.message;
}

}  // namespace
}  // namespace grainlaw::test
