// When bonds break (Liu, Bosco & Suiker 2017, eq. 8), and what becomes of their energy.
#include "bonded_lattice.hpp"
#include "boundary_support.hpp"
#include "law_support.hpp"

#include "base/error.hpp"
#include "boundary/boundary_space.hpp"
#include "increment/increment.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double kn = 1000;
constexpr double kt = 800;

ContactLaw law_of_bonds() {
  ContactLaw law;
  law.kind = LawKind::bonded;
  law.normal_stiffness = kn;
  law.ratio = kt / kn;
  law.friction = 0.5;
  law.bond.normal_strength = 30;
  law.bond.tangential_strength = 20;
  law.bond.bending_strength = 10;
  law.bond.bending_stiffness = 300;
  return law;
}

// Two discs of radius 1, bonded without force, in a wide cell.
struct Pair {
  Packing packing;
  ContactLaw law = law_of_bonds();
  BoundarySpace space;
  Problem problem;
  Increment increment;

  Pair() {
    packing.cell = {10, 0, 0, 10};
    packing.radius = {1, 1};
    packing.position = {0, 2, 0, 0};
    space = make_cell_space<2>(packing);
    problem = {&packing, &law, &space, 1, 1e-8};
    Configuration from;
    from.deformation = {1, 0, 0, 1};
    from.coordinates = {0, 2, 0, 0, 0, 0};
    from.contacts = {{0, 1, {}, false, true, {0}}};
    from.moments = {0};
    increment.begin(problem, from, identity);
  }
  double& x(std::size_t p) { return increment.motion().coordinate(0, p); }
  double& turn(std::size_t p) { return increment.motion().coordinate(2, p); }
};

// Breaks at `limit`, not before it.
template <class Move>
void expect_breaks_at(double limit, Move&& move) {
  for (const double share : {1 - 1e-9, 1 + 1e-9}) {
    Pair pair;
    move(pair, share * limit);
    EXPECT_EQ(pair.increment.overloads_bonds(), share > 1);
    EXPECT_EQ(pair.increment.break_bonds(), share > 1);
    EXPECT_EQ(pair.increment.contacts().bonded(0), share < 1);
    EXPECT_EQ(pair.increment.losses().broken_bonds(), share > 1 ? 1 : 0);
    EXPECT_FALSE(pair.increment.overloads_bonds());
  }
}

TEST(bond_failure, in_tension) {
  expect_breaks_at(30 / kn, [](Pair& pair, double by) { pair.x(1) += by; });
}

TEST(bond_failure, in_shear) {
  // Both turn alike: no bending. du = -d theta.
  expect_breaks_at(20 / (kt * 2), [](Pair& pair, double by) { pair.turn(0) = pair.turn(1) = by; });
}

TEST(bond_failure, in_bending) {
  // Against each other: no shear.
  expect_breaks_at(10.0 / 300 / 2, [](Pair& pair, double by) {
    pair.turn(0) = by;
    pair.turn(1) = -by;
  });
}

TEST(bond_failure, by_all_together) {
  // Half the tension, a quarter of the shear, a quarter of the moment, at the same share.
  expect_breaks_at(1, [](Pair& pair, double share) {
    const double stretched = 0.5 * 30 / kn * share;
    pair.x(1) += stretched;
    const double shear = 0.25 * 20 * share / (kt * (2 + stretched));
    const double bend = 0.25 * 10 * share / 300 / 2;
    pair.turn(0) = shear + bend;
    pair.turn(1) = shear - bend;
  });
}

TEST(bond_failure, is_put_off_by_compression) {
  // fn / fn_u counts with its sign.
  expect_breaks_at(2 * 20.0, [](Pair& pair, double force) {
    pair.x(1) -= 30 / kn;
    pair.turn(0) = pair.turn(1) = force / (kt * (2 - 30 / kn));
  });
}

MaterialDescription lattice() { return bonded_lattice(law_of_bonds()); }

TEST(bond_failure, bonds_longer_than_a_diameter_are_refused_by_name) {
  MaterialDescription description = lattice();
  description.law.bond.gap = 2.1;
  try {
    make_material(description);
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status, GRAINLAW_BAD_MATERIAL);
    EXPECT_STREQ(error.what(),
                 "contact.bond.gap: found 2.1, expected at most the largest diameter, 2");
  }
}

TEST(bond_failure, of_a_lattice_under_tension) {
  const auto material = make_material(lattice());
  EXPECT_EQ(material->initial.contacts.size(), 2U);
  State state(material);
  const double strain = 30 / (kn * 2);  // where the bonds along x are at their strength
  const Evaluation before = advance(state, {1 + strain * (1 - 1e-9), 0, 0, 1});
  EXPECT_NEAR(before.stress[0], 30 / (2 * 0.5), 1e-6);
  EXPECT_EQ(before.report.broken_bonds, 0);
  const Configuration committed = state.committed();
  const double stored = measure(state, GRAINLAW_ELASTIC_ENERGY);
  EXPECT_NEAR(stored, 0.5 * 30 * 30 / kn, 1e-6);

  const Evaluation after = evaluate(state, {1 + strain * (1 + 1e-9), 0, 0, 1}, TangentKind::exact);
  ASSERT_EQ(after.status, GRAINLAW_OK);
  EXPECT_EQ(after.report.broken_bonds, 1);
  EXPECT_EQ(measure(state, GRAINLAW_BROKEN_BONDS), 1);
  EXPECT_NEAR(after.stress[0], 0, 1e-9);
  EXPECT_NEAR(after.tangent[0], 0, 1e-6);
  EXPECT_NEAR(measure(state, GRAINLAW_DISSIPATED_ENERGY), stored, 1e-6);
  EXPECT_NEAR(measure(state, GRAINLAW_ELASTIC_ENERGY), 0, 1e-9);

  // The trial holds what broke; revert forgets it, commit makes it last.
  state.revert();
  EXPECT_TRUE(same_bits(state.committed(), committed));
  EXPECT_EQ(measure(state, GRAINLAW_BROKEN_BONDS), 0);
  EXPECT_EQ(evaluate(state, {1 + strain * (1 - 1e-9), 0, 0, 1}).stress, before.stress);
  advance(state, {1 + 2 * strain, 0, 0, 1});
  const Evaluation back = advance(state, {1 - strain, 0, 0, 1});
  EXPECT_NEAR(back.stress[0], -30, 1e-6);  // pushes again
  EXPECT_EQ(advance(state, {1 + strain / 2, 0, 0, 1}).stress[0], 0);
  EXPECT_EQ(measure(state, GRAINLAW_BROKEN_BONDS), 1);
}

TEST(bond_failure, of_a_lattice_in_shear) {
  // The disc turns by about half the shear, so that both bonds carry the same couple; with branches d
  // and 2 their forces are kt g 2^2 d / (2^2 + d^2) and the like, g the turning of the bond upwards.
  const auto material = make_material(lattice());
  const auto forces = [](double shear) {
    const double d = 2 * std::hypot(1, shear);
    const double couple = kt * std::atan(shear) * 4 * d * d / (4 + d * d);
    return std::array{couple / d, couple / 2, kn * (d - 2)};
  };
  double low = 0;
  double high = 0.1;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    const auto f = forces(middle);
    (std::max(f[0] / 20 + f[2] / 30, f[1] / 20) < 1 ? low : high) = middle;
  }
  State state(material);
  const Evaluation before = evaluate(state, {1, low * (1 - 1e-8), 0, 1});
  ASSERT_EQ(before.status, GRAINLAW_OK);
  EXPECT_EQ(before.report.broken_bonds, 0);
  const Evaluation after = evaluate(state, {1, high * (1 + 1e-8), 0, 1});
  EXPECT_GE(after.report.broken_bonds, 1);
}

TEST(bond_failure, does_not_lose_a_bond_that_is_stretched_far) {
  MaterialDescription description = lattice();
  description.law.bond.normal_strength = description.law.bond.tangential_strength =
      description.law.bond.bending_strength = 1e9;
  State state(make_material(description));
  advance(state, {1.8, 0, 0, 1}, 8);
  EXPECT_NEAR(state.committed().stress[0], kn * 1.6 / (2 * 0.5), 1e-6);
  EXPECT_EQ(state.committed().contacts.size(), 2U);
}

// Shear of a layer whose F22 is found under a prescribed P22, which does work.
TEST(bond_failure, of_a_layer_under_stress_balances_the_energy) {
  double coarse = 0;
  for (const int increments : {20, 100}) {
    auto description = describe_layer(small_packing(), -1e5);
    description.law = bonded_law(1);
    State state(make_material(description));
    const double volume = measure(state, GRAINLAW_REFERENCE_VOLUME);
    const double stored = measure(state, GRAINLAW_ELASTIC_ENERGY);
    EXPECT_EQ(measure(state, GRAINLAW_DISSIPATED_ENERGY), 0);
    double work = 0;
    double moved = 0;
    double dissipated = 0;
    for (int k = 1; k <= increments; ++k) {
      const Tensor before = deformation_of(state);
      const Tensor stress = stress_of(state);
      advance(state, {1, 8e-3 * k / increments, 0, 1});
      const Tensor change = sum(deformation_of(state), -1, before);
      const double done = 0.5 * volume * dot(sum(stress, 1, stress_of(state)), change);
      work += done;
      moved += std::abs(done);
      const double lost = measure(state, GRAINLAW_DISSIPATED_ENERGY);
      EXPECT_GE(lost, dissipated - 1e-9 * moved) << k;
      dissipated = lost;
    }
    EXPECT_GT(measure(state, GRAINLAW_BROKEN_BONDS), 5);
    const double error =
        std::abs(work - (measure(state, GRAINLAW_ELASTIC_ENERGY) - stored) - dissipated) / moved;
    if (increments == 100) {
      EXPECT_LE(error, 0.5 * coarse);
    }
    coarse = error;
  }
}

TEST(bond_failure, gives_the_same_bits_however_often_it_is_asked) {
  const auto material = make_material(describe_law(small_packing(), bonded_law(0.5)));
  State once(material);
  advance(once, {1.001, 0.002, 0, 0.998}, 2);
  const Tensor F{1.002, 0.004, 0, 0.996};
  const Evaluation first = evaluate(once, F);
  EXPECT_GT(first.report.broken_bonds, 0);
  evaluate(once, {1.001, 0.003, 0, 0.997});
  const Evaluation again = evaluate(once, F);
  EXPECT_EQ(first.stress, again.stress);
  EXPECT_EQ(first.report.broken_bonds, again.report.broken_bonds);
}

}  // namespace
}  // namespace grainlaw::core::test
