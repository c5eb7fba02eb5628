// Packings that are led to their stress in equilibrium: stiff ones, and anisotropic ones.
#include "generate/stress_control.hpp"

#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainlaw::core::test {
namespace {

// kn / (p t) of discs of mean radius 5 mm at 100 kPa and 0.1 m.
ContactLaw law_of(double stiffness, double friction = 0) {
  ContactLaw law;
  law.young = stiffness * 1e5 * 0.1 / 5e-3;
  law.ratio = 0.8;
  law.friction = friction;
  return law;
}

GeneratorOptions small(std::uint64_t seed, std::size_t count = 80) {
  GeneratorOptions options;
  options.count = count;
  options.seed = seed;
  return options;
}

void expect_pressure(const Packing& packing, const ContactLaw& law, double pressure) {
  const auto material = make_material(describe(packing, law, BoundaryType::periodic_cell, 1e-8));
  const auto& stress = material->initial.stress;
  EXPECT_NEAR(stress[0] / pressure, -1, 1e-5);
  EXPECT_NEAR(stress[3] / pressure, -1, 1e-5);
}

TEST(stress_control, stiff_packings_come_to_rest_for_every_seed) {
  for (const double stiffness : {1e4, 1e6})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const ContactLaw law = law_of(stiffness);
      SCOPED_TRACE(testing::Message() << "kn/p " << stiffness << ", seed " << seed);
      expect_pressure(consolidate(small(seed, 100), law), law, 1e5);
    }
}

TEST(stress_control, a_void_ratio_of_little_load_is_reached_from_above) {
  const ContactLaw law = law_of(300);
  GeneratorOptions options = small(1);
  const Packing soft = consolidate(options, law);
  // Just denser than where the stiffest packing of this seed stands.
  const ContactLaw stiff = law_of(1e5);
  const Packing barely = consolidate(options, stiff);
  double solid = 0;
  for (const double r : barely.radius) solid += M_PI * r * r;
  options.void_ratio = barely.cell[0] * barely.cell[3] / solid - 1 - 2e-4;
  const Packing packing = consolidate(options, stiff);
  EXPECT_NEAR(packing.cell[0] * packing.cell[3] / solid - 1, options.void_ratio, 1e-6);
  EXPECT_LT(soft.cell[0] * soft.cell[3], packing.cell[0] * packing.cell[3]);
  const auto material = make_material(describe(packing, stiff, BoundaryType::periodic_cell, 1e-8));
  EXPECT_NEAR(material->initial.stress[0] / material->initial.stress[3], 1, 1e-5);
}

TEST(stress_control, anisotropy_is_met_in_its_direction) {
  constexpr double degree = M_PI / 180;
  constexpr double wanted = 0.05;
  constexpr double direction = 90 * degree;
  const ContactLaw law = law_of(300, 0.4);
  GeneratorOptions options = small(1, 150);
  options.kind = GeneratorKind::lubachevsky_stillinger;
  options.friction = 0.4;
  options.anisotropy = wanted;
  options.anisotropy_direction = direction;
  const State state(
      make_material(describe(consolidate(options, law), law, BoundaryType::periodic_cell, 1e-8)));
  EXPECT_NEAR(measure(state, GRAINLAW_ANISOTROPY), wanted, 0.005);
  std::array<double, 4> fabric{};
  measure(state.material().problem(), state.current(), GRAINLAW_FABRIC, fabric.data());
  const double found = 0.5 * std::atan2(2 * fabric[1], fabric[0] - fabric[3]);
  EXPECT_LT(std::abs(std::remainder(found - direction, M_PI)), 5 * degree);
  const auto& stress = state.current().stress;
  EXPECT_NEAR(stress[0] + stress[3], -2e5, 20);
}

TEST(stress_control, gives_the_same_bits_again) {
  const ContactLaw law = law_of(1e5);
  const GeneratorOptions options = small(2, 60);
  const Packing a = consolidate(options, law);
  const Packing b = consolidate(options, law);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.cell, b.cell);
}

}  // namespace
}  // namespace grainlaw::core::test
