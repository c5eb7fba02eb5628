// Two or three discs under every law beyond plain friction, against closed forms.
#include "discs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace grainlaw::core::test {
namespace {

constexpr double kn = 1000;
constexpr double kt = 800;
constexpr double friction = 0.5;
constexpr double r = 1.5;  // common radius of radii 1 and 3
constexpr double distance = 3.9;
constexpr double overlap = 0.1;

ContactLaw linear() {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = kt / kn;
  law.friction = friction;
  return law;
}

ContactLaw compressive() {
  ContactLaw law;
  law.kind = LawKind::compressive;
  law.normal_stiffness = kn;
  return law;
}

constexpr double kr = 0.5 * kt * r * r;
constexpr double rolling_limit = 0.1 * r * kn * overlap;
ContactLaw rolling() {
  ContactLaw law = linear();
  law.rolling = {0.5, 0.1};
  return law;
}

constexpr double shear_modulus = 700;
constexpr double poisson = 0.25;
ContactLaw hertz(bool rotation = true) {
  ContactLaw law;
  law.kind = LawKind::hertz;
  law.shear_modulus = shear_modulus;
  law.poisson = poisson;
  law.ratio = 2 * (1 - poisson) / (2 - poisson);
  law.friction = friction;
  law.rotation = rotation;
  return law;
}
ContactLaw rolling_hertz() {
  ContactLaw law = hertz();
  law.rolling = {0.5, 0.1};
  return law;
}
// Guo & Zhao (2014), after eq. 9.
double hertz_kn(double depth) { return shear_modulus / (1 - poisson) * std::sqrt(2 * r * depth); }
double hertz_kt(double depth) {
  return 2 * shear_modulus / (2 - poisson) * std::sqrt(2 * r * depth);
}
double hertz_fn(double depth) { return 2.0 / 3 * hertz_kn(depth) * depth; }

constexpr double bending = 300;
ContactLaw bonded(bool rotation = true) {
  ContactLaw law = linear();
  law.kind = LawKind::bonded;
  law.rotation = rotation;
  law.bond.normal_strength = 30;
  law.bond.tangential_strength = 20;
  if (rotation) {
    law.bond.bending_strength = 10;
    law.bond.bending_stiffness = bending;
  }
  return law;
}

// Radii 1 and 3, overlap 0.1 along x, unturned; what they carry already.
struct Committed {
  double force = 0, moment = 0, gap = 0;
};
Discs pair(const ContactLaw& law, const Committed& committed = {}, bool bond = true) {
  std::vector<double> start{0, distance + committed.gap, 0, 0};
  if (law.rotating()) start.resize(6, 0.0);
  std::vector<double> moments, gaps;
  if (law.moments()) moments = {committed.moment};
  if (committed.gap != 0) gaps = {committed.gap - overlap};
  return {law,          {1, 3},  start, {{0, 1, {}, false, law.bonds() && bond, {committed.force}}},
          {{0, 1, {}}}, moments, gaps};
}

// What the loops give, as the point gives it.
void expect_loops_agree(Discs discs) {
  const auto point = discs.point();
  discs.evaluate();
  const double scale = kn * 1e-13;
  const auto& f = discs.list.forces[0];
  EXPECT_NEAR(f.x, point.normal_force * point.normal[0] - point.tangential_force * point.normal[1],
              scale);
  EXPECT_NEAR(f.y, point.normal_force * point.normal[1] + point.tangential_force * point.normal[0],
              scale);
  if (discs.law.moments()) {
    EXPECT_NEAR(f.moment, discs.moment(), scale);
    const double couple = -point.distance * point.tangential_force;
    EXPECT_NEAR(discs.force[4], 0.25 * couple - discs.moment(), 10 * scale);
    EXPECT_NEAR(discs.force[5], 0.75 * couple + discs.moment(), 10 * scale);
  }
}

TEST(compressive_contact, pushes_and_nothing_else) {
  const ContactLaw law = compressive();
  EXPECT_FALSE(law.rotating());
  Discs discs = pair(law);
  discs.y(1) = 0.3;  // oblique
  discs.evaluate();
  const double d = std::hypot(distance, 0.3);
  EXPECT_NEAR(discs.list.forces[0].x, kn * (4 - d) * distance / d, 1e-11);
  EXPECT_NEAR(discs.list.forces[0].y, kn * (4 - d) * 0.3 / d, 1e-11);
  EXPECT_EQ(discs.point().tangential_force, 0);
  EXPECT_NEAR(discs.energy(), 0.5 * kn * (4 - d) * (4 - d), 1e-11);
  discs.x(1) = 4.1;
  discs.evaluate();
  for (const double f : discs.force) EXPECT_EQ(f, 0);
  EXPECT_EQ(discs.point().status, ContactStatus::open);
}

TEST(hertz_contact, normal_force_is_the_integral_of_the_stiffness) {
  for (const double depth : {1e-6, 0.01, 0.3}) {
    Discs discs = pair(hertz());
    discs.x(1) = 4 - depth;
    EXPECT_NEAR(discs.point().normal_force, hertz_fn(depth), 1e-9 * hertz_fn(depth));
    const auto k = contact_stiffness(discs.list, 0, discs.point(), discs.law);
    EXPECT_NEAR(k[0], -hertz_kn(depth), 1e-9 * hertz_kn(depth));
    EXPECT_NEAR(discs.energy(), 0.4 * hertz_fn(depth) * depth, 1e-9 * hertz_fn(depth) * depth);
    expect_loops_agree(discs);
  }
}

TEST(hertz_contact, tangential_stiffness_follows_the_overlap) {
  for (const double depth : {0.02, 0.1, 0.2}) {
    Discs discs = pair(hertz());
    discs.x(1) = 4 - depth;
    discs.turn(0) = 1e-3;
    const double du = -(4 - depth) * 0.25e-3;
    EXPECT_NEAR(discs.point().tangential_force, -hertz_kt(depth) * du, 1e-11);
    expect_loops_agree(discs);
  }
}

TEST(hertz_contact, slides_exactly_at_the_friction_limit) {
  const double angle = friction * hertz_fn(overlap) / (hertz_kt(overlap) * distance * 0.25);
  Discs discs = pair(hertz());
  discs.turn(0) = angle * (1 - 1e-10);
  EXPECT_EQ(discs.point().status, ContactStatus::sticking);
  discs.turn(0) = angle * (1 + 1e-10);
  EXPECT_EQ(discs.point().status, ContactStatus::sliding);
  EXPECT_NEAR(discs.point().tangential_force, friction * hertz_fn(overlap), 1e-11);
  expect_loops_agree(discs);
}

TEST(hertz_contact, a_loaded_spring_keeps_its_energy_while_the_overlap_changes) {
  for (const ContactLaw& law : {hertz(), hertz(false), rolling_hertz()}) {
    Discs discs = pair(law, {4, 0.3});
    const double tangential = 0.5 * 16 / hertz_kt(overlap);
    const double moment = law.moments() ? 0.5 * 0.09 / (0.5 * hertz_kt(overlap) * r * r) : 0;
    EXPECT_NEAR(discs.energy(), 0.4 * hertz_fn(overlap) * overlap + tangential + moment, 1e-12);
    for (const double depth : {0.06, 0.12, 0.1}) {
      discs.x(1) = 4 - depth;
      EXPECT_NEAR(discs.point().tangential_force,
                  4 * std::sqrt(hertz_kt(depth) / hertz_kt(overlap)), 1e-11);
      EXPECT_NEAR(discs.energy(), 0.4 * hertz_fn(depth) * depth + tangential + moment, 1e-12);
      EXPECT_EQ(discs.advance(), 0);
    }
    EXPECT_NEAR(discs.point().tangential_force, 4, 1e-11);
    discs.x(1) = 4.1;  // opening loses it
    EXPECT_NEAR(discs.advance(), tangential + moment, 1e-12);
    EXPECT_EQ(discs.advance(), 0);
  }
}

TEST(rolling_contact, resists_the_relative_rotation) {
  Discs discs = pair(rolling());
  discs.turn(0) = 3e-3;  // the surfaces do not slide
  discs.turn(1) = -1e-3;
  EXPECT_NEAR(discs.point().tangential_force, 0, 1e-12);
  EXPECT_NEAR(discs.moment(), kr * 4e-3, 1e-12);
  EXPECT_NEAR(discs.energy(), 0.5 * kn * 0.01 + 0.5 * kr * 16e-6, 1e-12);
  discs.evaluate();
  EXPECT_NEAR(discs.force[4], -kr * 4e-3, 1e-12);
  EXPECT_NEAR(discs.force[5], kr * 4e-3, 1e-12);
}

TEST(rolling_contact, rolls_exactly_at_its_limit) {
  const double spin = rolling_limit / kr;
  for (const double side : {1.0, -1.0}) {
    Discs discs = pair(rolling());
    discs.turn(1) = side * spin * (1 - 1e-10) * 0.25;
    discs.turn(0) = -side * spin * (1 - 1e-10) * 0.75;
    EXPECT_LT(std::abs(discs.moment()), rolling_limit);
    discs.turn(1) *= 1.1;
    discs.turn(0) *= 1.1;
    EXPECT_NEAR(discs.moment(), -side * rolling_limit, 1e-12);
    expect_loops_agree(discs);
    // What was rolled beyond is lost; back again the spring unloads.
    EXPECT_NEAR(discs.advance(), rolling_limit * 0.1 * spin, 1e-6 * rolling_limit * spin);
    discs.turn(1) = side * spin * 0.05 * 0.25;
    discs.turn(0) = -side * spin * 0.05 * 0.75;
    EXPECT_NEAR(discs.moment(), -side * (rolling_limit - kr * spin * 1.05), 1e-8);
  }
}

TEST(rolling_contact, limit_follows_the_overlap_of_a_hertz_contact) {
  Discs discs = pair(rolling_hertz());
  discs.turn(0) = 0.3;
  discs.turn(1) = -0.1;
  EXPECT_NEAR(discs.moment(), 0.1 * r * hertz_fn(overlap), 1e-12);
  discs.turn(0) = 3e-4;
  discs.turn(1) = -1e-4;
  EXPECT_NEAR(discs.moment(), 0.5 * hertz_kt(overlap) * r * r * 4e-4, 1e-12);
  expect_loops_agree(discs);
}

TEST(bonded_contact, pulls_shears_and_bends_without_limit) {
  Discs discs = pair(bonded(), {5, 2});
  discs.x(1) = 4.2;  // stretched by 0.2
  discs.turn(0) = 0.3;
  discs.turn(1) = -0.2;
  const auto point = discs.point();
  EXPECT_EQ(point.status, ContactStatus::bonded);
  EXPECT_NEAR(point.normal_force, -kn * 0.2, 1e-11);
  EXPECT_NEAR(point.tangential_force, 5 + kt * 4.2 * (0.25 * 0.3 - 0.75 * 0.2), 1e-11);
  EXPECT_NEAR(discs.moment(), 2 + bending * 0.5, 1e-11);
  expect_loops_agree(discs);
  EXPECT_EQ(discs.advance(), 0);
}

TEST(bonded_contact, across_a_gap_has_no_force_at_first) {
  Discs discs = pair(bonded(), {0, 0, 0.3});  // at a distance of 4.2
  EXPECT_EQ(discs.point().normal_force, 0);
  discs.x(1) = 4.15;
  EXPECT_NEAR(discs.point().normal_force, kn * 0.05, 1e-11);
  expect_loops_agree(discs);
}

TEST(bonded_contact, once_broken_is_frictional) {
  for (const bool rotation : {true, false}) {
    Discs discs = pair(bonded(rotation), {}, false);
    Discs frictional = pair([&] {
      ContactLaw law = linear();
      law.rotation = rotation;
      return law;
    }());
    for (const double x : {3.9, 3.8, 4.1}) {
      for (Discs* both : {&discs, &frictional}) {
        both->x(1) = x;
        both->y(1) = 0.05;
        if (rotation) both->turn(0) = 0.4;
        both->evaluate();
      }
      EXPECT_EQ(discs.force, frictional.force);
      EXPECT_EQ(discs.point().status, frictional.point().status);
    }
  }
}

TEST(bonded_contact, locked_discs_resist_the_turning_of_the_branch) {
  Discs discs = pair(bonded(false));
  rotate(discs, 0.01);
  EXPECT_NEAR(discs.point().tangential_force, -kt * distance * 0.01, 1e-11);
  expect_loops_agree(discs);
}

TEST(bonded_contact, three_discs_in_a_row_bend_like_a_beam) {
  // The middle disc turns: both bonds bend, and their moments add up on it.
  ContactLaw law = bonded();
  Discs discs{law,
              {1, 1, 1},
              {0, 2, 4, 0, 0, 0, 0, 0, 0},
              {{0, 1, {}, false, true, {0}}, {1, 2, {}, false, true, {0}}},
              {{0, 1, {}}, {1, 2, {}}},
              {0, 0}};
  discs.turn(1) = 0.01;
  discs.evaluate();
  const double shear = kt * 2 * 0.005;
  EXPECT_NEAR(discs.force[7], -2 * shear - 2 * bending * 0.01, 1e-10);
  EXPECT_NEAR(discs.force[6], -shear + bending * 0.01, 1e-10);
  EXPECT_NEAR(discs.force[8], -shear + bending * 0.01, 1e-10);
  EXPECT_NEAR(discs.force[3], -shear, 1e-10);
  EXPECT_NEAR(discs.force[4], 0, 1e-10);  // up on one side, down on the other
}

struct Named {
  const char* name;
  ContactLaw law;
};
std::vector<Named> all_laws() {
  ContactLaw locked = linear();
  locked.rotation = false;
  ContactLaw then_rolling = bonded();
  then_rolling.rolling = {0.5, 0.1};
  return {{"frictional", linear()},
          {"locked", locked},
          {"compressive", compressive()},
          {"rolling", rolling()},
          {"hertz", hertz()},
          {"hertz, locked", hertz(false)},
          {"hertz, rolling", rolling_hertz()},
          {"bonded", bonded()},
          {"bonded, locked", bonded(false)},
          {"bonded, rolling", then_rolling}};
}

TEST(every_contact, feels_no_rigid_rotation) {
  for (const auto& [name, law] : all_laws()) {
    if (law.tangential() && !law.rotating()) continue;  // held against turning
    for (const double angle : {1e-6, 0.3, -1.0, 3.0}) {
      Discs discs = pair(law, {3, 0.5});
      Discs still = discs;
      rotate(discs, angle);
      EXPECT_NEAR(discs.point().normal_force, still.point().normal_force, 1e-10) << name;
      EXPECT_NEAR(discs.point().tangential_force, still.point().tangential_force, 1e-10) << name;
      if (law.moments()) {
        EXPECT_NEAR(discs.moment(), still.moment(), 1e-10) << name;
      }
      // The loops turn the force by their own arc tangent, exact to 1e-7 of the way round at worst.
      discs.evaluate();
      still.evaluate();
      EXPECT_NEAR(std::hypot(discs.force[1], discs.force[3]),
                  std::hypot(still.force[1], still.force[3]), 1e-6)
          << name;
    }
  }
}

TEST(every_contact, balances_forces_and_moments) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.04, 0.04);
  for (const auto& [name, law] : all_laws()) {
    for (int k = 0; k < 20; ++k) {
      Discs discs = pair(law, {100 * uniform(random), 10 * uniform(random)}, k % 2 == 0);
      for (double& value : discs.z) value += uniform(random);
      expect_loops_agree(discs);
      discs.evaluate();
      const auto& f = discs.force;
      EXPECT_NEAR(f[0] + f[1], 0, 1e-10) << name;
      EXPECT_NEAR(f[2] + f[3], 0, 1e-10) << name;
      if (!law.rotating()) continue;
      const double lx = discs.x(1) - discs.x(0);
      const double ly = discs.y(1) - discs.y(0);
      EXPECT_NEAR(lx * f[3] - ly * f[1] + f[4] + f[5], 0, 1e-9) << name;
    }
  }
}

// Around a closed path in `steps`: the work done on the contact, and what becomes of it.
struct Cycle {
  double work = 0, stored = 0, dissipated = 0;
  double moved = 0;  // work by its magnitude in every step
};
Cycle go_round(Discs discs, unsigned seed, int steps) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> amplitude[2];
  for (auto& a : amplitude) {
    for (std::size_t k = 0; k < discs.z.size(); ++k) a.push_back(0.04 * uniform(random));
  }
  const std::vector<double> start = discs.z;
  const double stored = discs.energy();
  Cycle cycle;
  discs.evaluate();
  std::vector<double> force = discs.force;
  std::vector<double> at = discs.z;
  for (int step = 1; step <= steps; ++step) {
    const double phase = 2 * M_PI * step / steps;
    for (std::size_t k = 0; k < discs.z.size(); ++k) {
      discs.z[k] = start[k] + amplitude[0][k] * std::sin(phase) +
                   amplitude[1][k] * (1 - std::cos(2 * phase));
    }
    discs.evaluate();
    for (std::size_t k = 0; k < discs.z.size(); ++k) {
      const double work = -0.5 * (force[k] + discs.force[k]) * (discs.z[k] - at[k]);
      cycle.work += work;
      cycle.moved += std::abs(work);
    }
    force = discs.force;
    at = discs.z;
    const double lost = discs.advance();
    EXPECT_GE(lost, 0);
    cycle.dissipated += lost;
  }
  cycle.stored = discs.energy() - stored;
  return cycle;
}

TEST(every_contact, gains_no_energy_over_a_closed_cycle) {
  for (const auto& [name, law] : all_laws()) {
    double coarse = 0;
    double fine = 0;
    double moved = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const bool bond = seed % 2 == 0;
      const Cycle few = go_round(pair(law, {}, bond), seed, 250);
      const Cycle many = go_round(pair(law, {}, bond), seed, 2000);
      coarse += std::abs(few.work - few.stored - few.dissipated);
      fine += std::abs(many.work - many.stored - many.dissipated);
      moved += many.moved;
      // The tangential springs start empty: nothing is there to be got out.
      EXPECT_GE(many.work, -1e-4 * many.moved) << name << ", seed " << seed;
    }
    EXPECT_LT(fine, 1e-3 * moved) << name;
    EXPECT_LT(fine, 0.2 * coarse + 1e-12 * moved) << name;  // of first order at least
  }
}

}  // namespace
}  // namespace grainlaw::core::test
