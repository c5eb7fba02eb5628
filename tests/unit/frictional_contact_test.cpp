// The frictional contact of two or three discs against closed forms.
#include "discs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr double kn = 1000;
constexpr double kt = 800;
constexpr double friction = 0.5;

ContactLaw rough() {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = kt / kn;
  law.friction = friction;
  return law;
}

// Radii 1 and 3, overlap 0.1 along x, unturned.
Discs pair(const ContactLaw& law = rough(), double committed = 0) {
  return {law, {1, 3}, {0, 3.9, 0, 0, 0, 0}, {{0, 1, {}, false, false, {committed}}}};
}

TEST(frictional_contact, pushes_with_stiffness_times_overlap) {
  Discs discs = pair();
  discs.evaluate();
  EXPECT_NEAR(discs.list.forces[0].x, kn * 0.1, 1e-11);
  EXPECT_EQ(discs.list.forces[0].y, 0);
  EXPECT_EQ(discs.force[0], -discs.force[1]);
  EXPECT_GT(discs.force[1], 0);
  const auto k = contact_stiffness(discs.point(), kn, kt, friction);
  EXPECT_EQ(k[0], -kn);
}

TEST(frictional_contact, stiffness_follows_the_moduli_of_both_discs) {
  ContactLaw law = rough();
  law.young = 6e8;
  EXPECT_DOUBLE_EQ(law.stiffness(0.004, 0.006), 6e8 * 2 * 0.004 * 0.006 / 0.01);
  Discs discs = pair(law);
  EXPECT_DOUBLE_EQ(discs.list.normal_stiffness[0], 6e8 * 1.5);
  EXPECT_DOUBLE_EQ(discs.list.tangential_stiffness[0], 6e8 * 1.5 * kt / kn);
}

TEST(frictional_contact, carries_nothing_when_open) {
  Discs discs = pair(rough(), 20);
  discs.x(1) = 4;
  discs.turn(0) = 0.1;
  discs.evaluate();
  for (const double f : discs.force) EXPECT_EQ(f, 0);
  EXPECT_EQ(discs.point().status, ContactStatus::open);
}

TEST(frictional_contact, sticks_against_an_oblique_motion) {
  // j moves by (-u, v): the branch turns by atan(v / (d - u)), the overlap grows.
  Discs discs = pair(rough(), 3);
  const double u = 0.02;
  const double v = 0.01;
  discs.x(1) -= u;
  discs.y(1) += v;
  discs.evaluate();
  const double d = std::hypot(3.9 - u, v);
  const double ft = 3 - kt * d * std::atan2(v, 3.9 - u);
  const double fn = kn * (4 - d);
  ASSERT_LT(std::abs(ft), friction * fn);
  const double c = (3.9 - u) / d;
  const double s = v / d;
  EXPECT_NEAR(discs.list.forces[0].x, fn * c - ft * s, 1e-11);
  EXPECT_NEAR(discs.list.forces[0].y, fn * s + ft * c, 1e-11);
  EXPECT_EQ(discs.point().status, ContactStatus::sticking);
}

TEST(frictional_contact, turning_one_disc_moves_its_surface) {
  Discs discs = pair();
  discs.turn(0) = 1e-3;
  // du = -d lambda_i theta_i with lambda_i = 1/4.
  EXPECT_NEAR(discs.point().tangential_force, kt * 3.9 * 0.25e-3, 1e-12);
  discs.turn(0) = 0;
  discs.turn(1) = 1e-3;
  EXPECT_NEAR(discs.point().tangential_force, kt * 3.9 * 0.75e-3, 1e-12);
}

TEST(frictional_contact, slides_exactly_at_the_friction_limit) {
  const double limit = friction * kn * 0.1;
  const double angle = limit / (kt * 3.9 * 0.25);  // of disc 0, where the limit is met
  Discs discs = pair();
  discs.turn(0) = angle * (1 - 1e-12);
  EXPECT_EQ(discs.point().status, ContactStatus::sticking);
  EXPECT_LT(discs.point().tangential_force, limit);
  discs.turn(0) = angle * (1 + 1e-12);
  EXPECT_EQ(discs.point().status, ContactStatus::sliding);
  EXPECT_NEAR(discs.point().tangential_force, limit, 1e-11);
  discs.turn(0) = -3 * angle;
  EXPECT_EQ(discs.point().status, ContactStatus::sliding);
  EXPECT_NEAR(discs.point().tangential_force, -limit, 1e-11);
}

TEST(frictional_contact, rolling_without_sliding_gives_no_tangential_force) {
  Discs discs = pair();
  discs.turn(0) = 0.3;
  discs.turn(1) = -0.1;  // lambda_i theta_i + lambda_j theta_j = 0
  EXPECT_NEAR(discs.point().tangential_force, 0, 1e-12);
  // Disc 0 rolls round the fixed disc 1: the branch turns, and disc 0 by that over lambda_i.
  Discs round = pair();
  const double angle = 0.4;
  round.x(0) = 3.9 - 3.9 * std::cos(angle);
  round.y(0) = -3.9 * std::sin(angle);
  round.turn(0) = angle / 0.25;
  EXPECT_NEAR(round.point().slip_angle, 0, 1e-14);
  EXPECT_NEAR(round.point().tangential_force, 0, 1e-11);
}

TEST(frictional_contact, rigid_rotation_changes_nothing) {
  for (const double angle : {1e-6, 0.3, -1.0}) {
    Discs discs = pair(rough(), 20);
    rotate(discs, angle);
    const auto point = discs.point();
    EXPECT_NEAR(point.slip_angle, 0, 1e-15);
    EXPECT_NEAR(point.tangential_force, 20, 1e-11);
    EXPECT_NEAR(point.normal_force, kn * 0.1, 1e-11);
  }
}

TEST(frictional_contact, forces_and_moments_balance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.04, 0.04);
  for (int k = 0; k < 100; ++k) {
    Discs discs = pair(rough(), 100 * uniform(random));
    for (double& value : discs.z) value += uniform(random);
    discs.evaluate();
    const auto& f = discs.force;
    const double lx = discs.x(1) - discs.x(0);
    const double ly = discs.y(1) - discs.y(0);
    EXPECT_EQ(f[0] + f[1], 0);
    EXPECT_EQ(f[2] + f[3], 0);
    // l x f_j + m_i + m_j = 0.
    EXPECT_NEAR(lx * f[3] - ly * f[1] + f[4] + f[5], 0, 1e-12 * kn);
  }
}

TEST(frictional_contact, without_friction_only_pushes) {
  ContactLaw law = rough();
  law.friction = 0;
  Discs discs{law, {1, 3}, {0, 3.9, 0, 0}};
  discs.y(1) = 0.2;
  discs.evaluate();
  const double d = std::hypot(3.9, 0.2);
  EXPECT_NEAR(discs.list.forces[0].x, kn * (4 - d) * 3.9 / d, 1e-11);
  EXPECT_NEAR(discs.list.forces[0].y, kn * (4 - d) * 0.2 / d, 1e-11);
  EXPECT_EQ(discs.advance(), 0);
}

TEST(frictional_contact, locked_discs_resist_the_turning_of_the_branch) {
  ContactLaw law = rough();
  law.rotation = false;
  Discs discs{law, {1, 3}, {0, 3.9, 0, 0}};
  const double angle = 0.01;
  rotate(discs, angle);
  discs.evaluate();
  EXPECT_NEAR(discs.point().tangential_force, -kt * 3.9 * angle, 1e-11);
  EXPECT_EQ(discs.force.size(), 4U);
}

TEST(frictional_contact, disc_touches_its_own_image) {
  // A cell as wide as the disc, less 0.1: the disc pushes on itself, and no net force is left.
  const std::array<double, 4> narrow{1.9, 0.2, 0, 10};
  const std::vector<NeighbourPair> pairs{{0, 0, {1, 0}}};
  const std::vector<double> radius{1};
  const std::vector<double> start{0.3, 0.4, 0};
  const ContactLaw law = rough();
  ContactList list;
  test::build(pairs, radius, law, narrow, {start, narrow, {}}, list);
  std::vector<double> z = start;
  z[2] = 0.01;
  const auto force = test::forces(z, radius, law, list);
  EXPECT_NEAR(list.forces[0].x, kn * 0.1, 1e-11);
  EXPECT_NEAR(list.forces[0].y, kt * 1.9 * 0.01, 1e-11);  // both sides turn
  EXPECT_EQ(force[0], 0);
  EXPECT_EQ(force[1], 0);
  EXPECT_NEAR(force[2], -1.9 * kt * 1.9 * 0.01, 1e-11);
  // A simple shear of the cell turns the branch.
  const std::array<double, 4> sheared{1.9, 0.2, 0.02, 10};
  test::build(pairs, radius, law, sheared, {start, narrow, {}}, list);
  const double d = std::hypot(1.9, 0.02);
  EXPECT_NEAR(test::forces(start, radius, law, list)[2], d * kt * d * std::atan2(0.02, 1.9), 1e-10);
}

TEST(frictional_contact, three_discs_in_a_row_add_up) {
  Discs discs{rough(), {1, 1, 1}, {0, 1.9, 3.7, 0, 0, 0, 0, 0, 0}, {}, {{0, 1, {}}, {1, 2, {}}}};
  discs.turn(1) = 0.01;
  discs.evaluate();
  EXPECT_NEAR(discs.force[1], kn * (0.1 - 0.2), 1e-10);
  const double left = kt * 1.9 * 0.005;   // on disc 1 by disc 0, upwards
  const double right = kt * 1.8 * 0.005;  // on disc 2 by disc 1, upwards
  EXPECT_NEAR(discs.force[3], -left, 1e-11);
  EXPECT_NEAR(discs.force[4], left - right, 1e-11);
  EXPECT_NEAR(discs.force[5], right, 1e-11);
  EXPECT_NEAR(discs.force[7], -0.5 * (1.9 * left + 1.8 * right), 1e-11);
}

TEST(frictional_contact, slip_dissipates_its_work) {
  // Disc 0 turns at constant overlap, in steps: it sticks up to the limit, then slides.
  Discs discs = pair();
  const double limit = friction * kn * 0.1;
  const double per_turn = 3.9 * 0.25;  // displacement by turning disc 0
  double lost = 0;
  for (int k = 1; k <= 20; ++k) {
    discs.turn(0) = 0.01 * k;
    const double now = discs.advance();
    EXPECT_GE(now, 0);
    lost += now;
  }
  const double slip = 0.2 * per_turn - limit / kt;
  ASSERT_GT(slip, 0);
  EXPECT_NEAR(lost, limit * slip, 1e-12 * limit);
  // Turning back it sticks at first: the spring unloads without loss.
  discs.turn(0) = 0.2 - limit / kt / per_turn;
  EXPECT_EQ(discs.advance(), 0);
  EXPECT_NEAR(discs.point().tangential_force, 0, 1e-11);
}

TEST(frictional_contact, opening_dissipates_what_the_spring_held) {
  Discs discs = pair(rough(), 20);
  discs.x(1) = 4.1;
  EXPECT_NEAR(discs.advance(), 0.5 * 20 * 20 / kt, 1e-12);
  EXPECT_EQ(discs.advance(), 0);
}

TEST(frictional_contact, unloading_below_the_limit_dissipates_as_much_as_opening) {
  // The overlap falls until the limit is next to nothing: whether the contact then counts as open
  // is a matter of rounding, and must not matter to the energy.
  Discs discs = pair(rough(), 20);
  discs.x(1) = 4 - 1e-14;
  EXPECT_NEAR(discs.advance(), 0.5 * 20 * 20 / kt, 1e-9);
}

TEST(frictional_contact, advanced_history_is_where_the_next_step_starts) {
  Discs once = pair(rough(), 10);
  once.turn(0) = 0.02;
  Discs twice = pair(rough(), 10);
  twice.turn(0) = 0.005;
  twice.advance();
  twice.turn(0) = 0.02;
  EXPECT_NEAR(twice.point().tangential_force, once.point().tangential_force, 1e-11);
}

}  // namespace
}  // namespace grainlaw::core::test
