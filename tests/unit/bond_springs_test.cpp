// Bonds with springs of their own, kb_n and kb_s (Liu, Bosco & Suiker 2017, eq. 7): in closed form, and where
// one breaks.
#include "bonded_lattice.hpp"
#include "discs.hpp"
#include "few_spheres.hpp"
#include "law_support.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double kn = 1000, kt = 800, of_bond_n = 2500, of_bond_t = 300, friction = 0.5;

ContactLaw law_of_bonds() {
  ContactLaw law;
  law.kind = LawKind::bonded;
  law.normal_stiffness = kn;
  law.ratio = kt / kn;
  law.friction = friction;
  law.bond.normal_stiffness = of_bond_n;
  law.bond.tangential_stiffness = of_bond_t;
  law.bond.normal_strength = law.bond.tangential_strength = 30;
  return law;
}

// Two discs of radius 1 that just touch.
Discs two_discs(bool bonded) {
  return {law_of_bonds(), {1, 1}, {0, 2, 0, 0, 0, 0}, {{0, 1, {}, false, bonded, {0}}}};
}

TEST(bond_springs, bear_a_gap_and_an_overlap_in_closed_form) {
  for (const double gap : {1e-3, -2e-3}) {
    Discs discs = two_discs(true);
    discs.x(1) += gap;
    discs.turn(0) = discs.turn(1) = 1e-3;
    const auto point = discs.point();
    const double shear = of_bond_t * (2 + gap) * 1e-3;
    EXPECT_NEAR(point.normal_force / (-of_bond_n * gap), 1, 1e-7);
    EXPECT_NEAR(point.tangential_force / shear, 1, 1e-7);
    EXPECT_NEAR(discs.energy(), 0.5 * of_bond_n * gap * gap + 0.5 * shear * shear / of_bond_t,
                1e-12);
    discs.evaluate();
    EXPECT_NEAR(discs.force[1] / (-of_bond_n * gap), 1, 1e-7);
  }
}

TEST(bond_springs, are_not_those_of_other_contacts) {
  Discs discs = two_discs(false);
  discs.x(1) -= 2e-3;
  EXPECT_NEAR(discs.point().normal_force, kn * 2e-3, 1e-12);
}

TEST(bond_springs, of_spheres_bear_in_closed_form) {
  sphere_test::Spheres spheres(law_of_bonds(), {1, 1}, {0, 2, 0, 0, 0, 0});
  spheres.z[1] += 1e-3;
  spheres.turn(0, {0, 0, 1}, 1e-3);
  spheres.turn(1, {0, 0, 1}, 1e-3);
  const auto point = spheres.point();
  EXPECT_NEAR(point.normal_force / (-of_bond_n * 1e-3), 1, 1e-7);
  EXPECT_NEAR(length<3>(point.tangential_force) / (of_bond_t * 2.001 * 1e-3), 1, 1e-6);
  const auto forces = spheres.forces();
  EXPECT_NEAR(forces[1].x / (-of_bond_n * 1e-3), 1, 1e-7);
}

MaterialDescription lattice() { return bonded_lattice(law_of_bonds()); }

TEST(bond_springs, make_the_stress_the_tangent_and_the_energy_of_a_lattice) {
  State state(make_material(lattice()));
  const double stretch = 2e-3;
  const Evaluation at = evaluate(state, {1 + stretch, 0, 0, 1}, TangentKind::exact);
  EXPECT_NEAR(at.stress[0], of_bond_n * 2 * stretch / (2 * 0.5), 1e-6);
  EXPECT_NEAR(at.tangent[0], of_bond_n * 2 / (2 * 0.5), 1e-4);
  EXPECT_NEAR(measure(state, GRAINLAW_ELASTIC_ENERGY), 0.5 * of_bond_n * 4 * stretch * stretch,
              1e-9);
  double least = 0;
  for (const auto& contact : contact_views(state.material().problem(), state.current()))
    least = std::min(least, contact.normal_force);
  EXPECT_NEAR(least, -of_bond_n * 2 * stretch, 1e-9);
}

TEST(bond_springs, give_way_to_those_of_the_contact_where_a_bond_breaks) {
  State state(make_material(lattice()));
  const double limit = 30 / (of_bond_n * 2);
  EXPECT_EQ(advance(state, {1 + limit * (1 - 1e-9), 0, 0, 1}).report.broken_bonds, 0);
  EXPECT_EQ(advance(state, {1 + limit * (1 + 1e-9), 0, 0, 1}).report.broken_bonds, 1);
  const double lost = measure(state, GRAINLAW_DISSIPATED_ENERGY);
  EXPECT_NEAR(lost, 0.5 * 30 * 30 / of_bond_n, 1e-6);
  const Evaluation back = advance(state, {1 - 2e-3, 0, 0, 1});
  EXPECT_NEAR(back.stress[0], -kn * 4e-3 / (2 * 0.5), 1e-6);
  EXPECT_NEAR(measure(state, GRAINLAW_ELASTIC_ENERGY), 0.5 * kn * 4e-3 * 4e-3, 1e-9);
}

TEST(bond_springs, bring_a_generated_packing_to_its_pressure) {
  MaterialDescription description;
  description.packing.dimension = 2;
  auto& generator = description.generator.emplace();
  generator.kind = GeneratorKind::hexagonal;
  generator.columns = generator.rows = 2;
  generator.radius_max = 1;
  generator.pressure = 1;
  description.law = law_of_bonds();
  const auto material = make_material(std::move(description));
  EXPECT_NEAR(material->initial.stress[0], -1, 1e-3);
  EXPECT_NEAR(material->initial.stress[3], -1, 1e-3);
}

// Its time step is that of the stiffest springs.
TEST(bond_springs, a_hundred_times_as_stiff_as_contacts_are_relaxed_as_published) {
  ContactLaw law = springy_bonded_law(1e6);
  law.bond.normal_stiffness = 3e8;
  MaterialDescription description = describe_law(without_rattlers(small_packing()), law);
  description.solver.tolerance = 1e-5;
  Tensor found[2];
  for (const Method method : {Method::direct, Method::published}) {
    description.solver.method = method;
    State state(make_material(description));
    const Evaluation at = evaluate(state, {1.0002, 1e-4, 0, 0.9996});
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    found[method == Method::published ? 1 : 0] = at.stress;
  }
  EXPECT_LE(relative_difference(found[1], found[0]), 1e-3);
}

// Tangential springs then decide how far a step of a relaxation may go.
TEST(bond_springs, that_shear_ten_times_as_stiff_as_they_bear_find_their_equilibrium) {
  ContactLaw bonds = springy_bonded_law(1e6), contacts = rough_law();
  bonds.bond.tangential_stiffness = 10 * bonds.bond.normal_stiffness;
  contacts.ratio = 10;
  for (const ContactLaw& law : {bonds, contacts}) {
    MaterialDescription description = describe_law(without_rattlers(small_packing()), law);
    description.packing.contacts.clear();
    State state(make_material(description));
    const Evaluation at = evaluate(state, {1.0002, 1e-4, 0, 0.9996}, TangentKind::exact);
    ASSERT_EQ(at.status, GRAINLAW_OK) << at.report.message;
    EXPECT_LE(at.report.residual, description.solver.tolerance);
    EXPECT_LT(at.report.relaxation_steps, 5000);
  }
}

TEST(bond_springs, of_another_stiffness_are_another_material) {
  auto description = lattice();
  const auto one = make_material(description);
  description.law.bond.tangential_stiffness *= 2;
  const auto other = make_material(description);
  description.law.bond.normal_stiffness = description.law.bond.tangential_stiffness = 0;
  EXPECT_NE(one->fingerprint, other->fingerprint);
  EXPECT_NE(one->fingerprint, make_material(description)->fingerprint);
}

}  // namespace
}  // namespace grainlaw::core::test
