// What a packing tells about itself: the reference packing at its start, and closed forms.
#include "support.hpp"

#include <numbers>

namespace grainlaw::core::test {
namespace {

const State& reference_state() {
  static const State state(make_material(describe(reference_packing(), rough_law())));
  return state;
}

Tensor tensor(const State& state, grainlaw_measure what) {
  Tensor value{};
  EXPECT_EQ(measure_count(state.material().packing.dimension, what), 4);
  measure(state.material().problem(), state.current(), what, value.data());
  return value;
}

TEST(measures, of_the_reference_packing_are_those_of_its_maker) {
  const State& state = reference_state();
  EXPECT_NEAR(measure(state, GRAINLAW_VOID_RATIO), 0.17499883728196411, 1e-12);
  EXPECT_EQ(measure(state, GRAINLAW_CONTACTS), 831);
  EXPECT_EQ(measure(state, GRAINLAW_PARTICLES), 400);
  EXPECT_DOUBLE_EQ(measure(state, GRAINLAW_COORDINATION), 4.155);
  EXPECT_NEAR(measure(state, GRAINLAW_COORDINATION_NO_RATTLERS), 4.284, 5e-4);
  EXPECT_EQ(measure(state, GRAINLAW_DISSIPATED_ENERGY), 0);
  EXPECT_EQ(measure(state, GRAINLAW_BROKEN_BONDS), 0);
  EXPECT_NEAR(measure(state, GRAINLAW_MEAN_ROTATION), 0, 1e-8);
  const Tensor sigma = tensor(state, GRAINLAW_CAUCHY_STRESS);
  const Tensor expected{-100000.013, 616.825478, 616.825478, -100000.017};
  EXPECT_LE(relative_difference(sigma, expected), 1e-7);
}

TEST(measures, coordination_leaves_out_particles_with_less_than_two_contacts) {
  const State& state = reference_state();
  std::vector<int> count(400);
  for (const auto& contact : state.current().contacts) {
    ++count[static_cast<std::size_t>(contact.i)];
    ++count[static_cast<std::size_t>(contact.j)];
  }
  const auto none = std::count(count.begin(), count.end(), 0);
  const auto one = std::count(count.begin(), count.end(), 1);
  EXPECT_GT(none, 0);
  EXPECT_DOUBLE_EQ(measure(state, GRAINLAW_COORDINATION_NO_RATTLERS),
                   static_cast<double>(2 * 831 - one) / static_cast<double>(400 - none - one));
}

TEST(measures, mean_overlap_and_energy_are_sums_over_the_given_forces) {
  double overlap = 0;
  double energy = 0;
  const auto& packing = reference_packing();
  const ContactLaw law = rough_law();
  for (const auto& c : packing.contacts) {
    const double kn = law.stiffness(packing.radius[static_cast<std::size_t>(c.i)],
                                    packing.radius[static_cast<std::size_t>(c.j)]);
    const double ft = std::hypot(c.tangential_force[0], c.tangential_force[1]);
    overlap += c.normal_force / kn / static_cast<double>(packing.contacts.size());
    energy += 0.5 * c.normal_force * c.normal_force / kn + 0.5 * ft * ft / (law.ratio * kn);
  }
  EXPECT_NEAR(measure(reference_state(), GRAINLAW_MEAN_OVERLAP), overlap, 1e-7 * overlap);
  EXPECT_NEAR(measure(reference_state(), GRAINLAW_ELASTIC_ENERGY), energy, 1e-7 * energy);
}

TEST(measures, fabric_and_anisotropy_follow_their_equations) {
  State state = reference_state();
  advance(state, {1.002, 0.001, 0, 0.996}, 4);
  Tensor fabric{};  // Guo & Zhao (2014) eq. 22
  const auto views = contact_views(state.material().problem(), state.current());
  for (const auto& c : views) {
    const double d = std::hypot(c.branch[0], c.branch[1]);
    const double n[2] = {c.branch[0] / d, c.branch[1] / d};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        fabric[2 * i + j] += n[i] * n[j] / static_cast<double>(views.size());
      }
    }
  }
  EXPECT_LE(relative_difference(tensor(state, GRAINLAW_FABRIC), fabric), 1e-13);
  EXPECT_NEAR(fabric[0] + fabric[3], 1, 1e-13);
  // Eigenvalues by the characteristic polynomial.
  const double det = fabric[0] * fabric[3] - fabric[1] * fabric[2];
  const double root = std::sqrt(0.25 - det);
  EXPECT_NEAR(measure(state, GRAINLAW_ANISOTROPY), (0.5 + root) / (0.5 - root) - 1, 1e-11);
  // Eqs. 24-25: F_a = sqrt(1/2 Fa : Fa), Fa = 4 (fabric - 1/2 I).
  const Tensor deviator = sum(fabric, -0.5, identity);
  const double intensity = std::sqrt(0.5 * 16 * dot(deviator, deviator));
  EXPECT_NEAR(measure(state, GRAINLAW_FABRIC_INTENSITY), intensity, 1e-13);
  EXPECT_GT(intensity, 0.01);
  EXPECT_GT(fabric[3], fabric[0]);  // more contacts along the compression
}

// Square lattice of discs of radius 1 in a rectangular cell: overlaps 0.2 along x, 0.1 along y.
std::shared_ptr<const Material> lattice() {
  Packing packing;
  packing.thickness = 0.5;
  packing.cell = {3.6, 0, 0, 3.8};
  packing.position = {0, 1.8, 0, 1.8, 0, 0, 1.9, 1.9};
  packing.radius = {1, 1, 1, 1};
  ContactLaw law;
  law.normal_stiffness = 1000;
  return make_material(describe(packing, law));
}

TEST(measures, of_a_lattice_are_closed_forms) {
  const State state(lattice());
  const double volume = 3.6 * 3.8 * 0.5;
  EXPECT_NEAR(measure(state, GRAINLAW_VOLUME), volume, 1e-14);
  EXPECT_NEAR(measure(state, GRAINLAW_VOID_RATIO), 3.6 * 3.8 / (4 * std::numbers::pi) - 1, 1e-14);
  EXPECT_EQ(measure(state, GRAINLAW_CONTACTS), 8);
  EXPECT_EQ(measure(state, GRAINLAW_COORDINATION), 4);
  EXPECT_EQ(measure(state, GRAINLAW_COORDINATION_NO_RATTLERS), 4);
  EXPECT_NEAR(measure(state, GRAINLAW_MEAN_OVERLAP), 0.15, 1e-14);
  EXPECT_NEAR(measure(state, GRAINLAW_ELASTIC_ENERGY), 4 * 0.5 * 1000 * (0.04 + 0.01), 1e-10);
  EXPECT_NEAR(measure(state, GRAINLAW_ANISOTROPY), 0, 1e-14);
  const Tensor sigma = tensor(state, GRAINLAW_CAUCHY_STRESS);
  EXPECT_NEAR(sigma[0], -4 * 200 * 1.8 / volume, 1e-9);
  EXPECT_NEAR(sigma[3], -4 * 100 * 1.9 / volume, 1e-9);
  EXPECT_NEAR(sigma[1], 0, 1e-9);
  EXPECT_NEAR(sigma[2], 0, 1e-9);
}

TEST(measures, follow_the_deformation) {
  State state(lattice());
  const Tensor F = product(rotation(0.2), {1.01, 0, 0, 0.98});
  const Evaluation at = evaluate(state, F);
  ASSERT_EQ(at.status, GRAINLAW_OK);
  EXPECT_NEAR(measure(state, GRAINLAW_VOLUME), 3.6 * 3.8 * 0.5 * 1.01 * 0.98, 1e-13);
  EXPECT_NEAR(measure(state, GRAINLAW_REFERENCE_VOLUME), 3.6 * 3.8 * 0.5, 1e-13);
  EXPECT_NEAR(measure(state, GRAINLAW_MEAN_OVERLAP), 0.5 * (2 - 1.818 + 2 - 1.862), 1e-13);
  EXPECT_LE(relative_difference(tensor(state, GRAINLAW_DEFORMATION_GRADIENT), F), 1e-15);
  const Tensor sigma = tensor(state, GRAINLAW_CAUCHY_STRESS);
  Tensor expected = product(at.stress, transpose(F));
  for (double& value : expected) value /= 1.01 * 0.98;
  EXPECT_LE(relative_difference(sigma, expected), 1e-13);
}

TEST(measures, mean_rotation_follows_a_rigid_rotation) {
  State state = reference_state();
  advance(state, rotation(0.25));
  EXPECT_NEAR(measure(state, GRAINLAW_MEAN_ROTATION), 0.25, 1e-7);
}

}  // namespace
}  // namespace grainlaw::core::test
