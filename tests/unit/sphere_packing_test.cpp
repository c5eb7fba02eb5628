// Random packings of spheres: loose, grown, compressed to a pressure or a void ratio, anisotropic.
#include "base/error.hpp"
#include "generate/compaction.hpp"
#include "generate/lubachevsky_stillinger.hpp"
#include "packing/neighbours.hpp"
#include "sphere_support.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace grainlaw::core::sphere_test {
namespace {

GeneratorOptions hundred(std::uint64_t seed = 1) {
  GeneratorOptions options;
  options.count = 100;
  options.seed = seed;
  return options;
}

ContactLaw law() {
  ContactLaw law;
  law.young = 1e8;
  law.ratio = 0.8;
  law.friction = 0.5;
  return law;
}

struct Summary {
  Tensor<3> stress{};      // Cauchy [Pa]
  double void_ratio = 0;   // [-]
  double unbalanced = 0;   // largest component of a particle's force / mean normal force [-]
  double sliding = 0;      // largest |ft| / fn [-]
  double slip_excess = 0;  // largest |ft| - friction fn / mean normal force [-]
};

// From the packing's own contact forces alone.
Summary summary(const Packing& packing, double friction = 0) {
  Summary s;
  const std::size_t n = packing.size();
  const Tensor<3> cell = tensor_of<3>(packing.cell);
  const double volume = determinant<3>(cell);
  std::vector<double> force(3 * n, 0.0);
  double mean = 0;
  for (const InitialContact& c : packing.contacts) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const Vec<3> l = branch<3>(packing.position.data(), n, i, j, cell, vec_of<3>(c.shift));
    mean += c.normal_force / static_cast<double>(packing.contacts.size());
    const double tangential = length<3>(c.tangential_force);
    s.sliding = std::max(s.sliding, tangential / c.normal_force);
    s.slip_excess = std::max(s.slip_excess, tangential - friction * c.normal_force);
    for (std::size_t a = 0; a < 3; ++a) {
      const double f = c.normal_force * l[a] / length<3>(l) + c.tangential_force[a];
      force[a * n + j] += f;
      force[a * n + i] -= f;
      for (std::size_t b = 0; b < 3; ++b) s.stress[3 * a + b] -= f * l[b] / volume;
    }
  }
  s.slip_excess /= mean;
  for (const double f : force) s.unbalanced = std::max(s.unbalanced, std::abs(f) / mean);
  double solid = 0;
  for (const double r : packing.radius) solid += particle_size<3>(r);
  s.void_ratio = volume / solid - 1;
  return s;
}

std::size_t pairs_within(const Packing& packing, double gap) {
  std::vector<NeighbourPair<3>> pairs;
  NeighbourSearch<3>().find(packing.size(), packing.position.data(), packing.radius.data(),
                            packing.cell.data(), gap, pairs);
  return pairs.size();
}

void expect_pressure(const Summary& s, double pressure) {
  for (const std::size_t k : {0U, 4U, 8U}) EXPECT_NEAR(s.stress[k] / pressure, -1, 1e-6) << k;
  EXPECT_NEAR(s.stress[1] / pressure, s.stress[3] / pressure, 1e-7);
  EXPECT_NEAR(s.stress[2] / pressure, s.stress[6] / pressure, 1e-7);
  EXPECT_NEAR(s.stress[5] / pressure, s.stress[7] / pressure, 1e-7);
  EXPECT_LT(s.unbalanced, 1e-8);
}

TEST(loose_spheres, do_not_touch) {
  for (const std::size_t count : {1U, 2U, 10U, 400U}) {
    GeneratorOptions options = hundred(count);
    options.count = count;
    const Packing packing = scatter<3>(options);
    EXPECT_EQ(packing.dimension, 3);
    EXPECT_EQ(pairs_within(packing, 0), 0U);
    EXPECT_NEAR(summary(packing).void_ratio, 3, 1e-12);
  }
}

TEST(grown_spheres, jam_near_random_close_packing_without_overlaps) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Packing packing = grow<3>(hundred(seed));
    EXPECT_EQ(pairs_within(packing, 0), 0U);
    EXPECT_NEAR(1 / (1 + summary(packing).void_ratio), 0.645, 0.015);
    // Nearly isostatic: about three contacts per sphere that bears load, one in ten or so rattles.
    const std::size_t near = pairs_within(packing, 1e-3 * 5e-3);
    EXPECT_GT(near, 200U);
    EXPECT_LT(near, 300U);
  }
  for (const std::size_t count : {2U, 3U, 8U}) {
    GeneratorOptions options = hundred();
    options.count = count;
    EXPECT_EQ(pairs_within(grow<3>(options), 0), 0U) << count;
  }
}

TEST(grown_spheres, end_at_the_volume_fraction_wanted) {
  GeneratorOptions options = hundred();
  options.growth_end = 0.5;
  EXPECT_NEAR(summary(grow<3>(options)).void_ratio, 1, 1e-9);
  options.growth_end = 0.7;
  EXPECT_THROW(grow<3>(options), Error);
  options.growth_end = 0.1;
  EXPECT_THROW(grow<3>(options), Error);
}

TEST(packed_spheres, reach_the_pressure_at_rest) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Summary s = summary(consolidate<3>(hundred(seed), law()));
    expect_pressure(s, 1e5);
    EXPECT_EQ(s.sliding, 0);
    EXPECT_NEAR(s.void_ratio, 0.54, 0.03);
  }
}

TEST(packed_spheres, five_hundred_reach_it_too_grown_or_scattered) {
  for (const auto kind : {GeneratorKind::compaction, GeneratorKind::lubachevsky_stillinger}) {
    GeneratorOptions options = hundred();
    options.count = 500;
    options.kind = kind;
    options.friction = kind == GeneratorKind::compaction ? 0.5 : 0;
    expect_pressure(summary(consolidate<3>(options, law())), 1e5);
  }
}

TEST(packed_spheres, that_are_stiff_reach_a_low_pressure) {
  GeneratorOptions options = hundred();
  options.pressure = 3e3;
  expect_pressure(summary(consolidate<3>(options, law())), 3e3);
}

TEST(packed_spheres, reach_the_void_ratio_with_equal_stresses) {
  GeneratorOptions options = hundred();
  options.void_ratio = 0.5;
  const Summary s = summary(consolidate<3>(options, law()));
  EXPECT_NEAR(s.void_ratio, 0.5, 1e-9);
  EXPECT_LT(s.stress[0], -1e4);
  EXPECT_NEAR(s.stress[4] / s.stress[0], 1, 1e-6);
  EXPECT_NEAR(s.stress[8] / s.stress[0], 1, 1e-6);
  EXPECT_LT(s.unbalanced, 1e-8);
  options.count = 20;
  options.void_ratio = 0.9;
  EXPECT_THROW(consolidate<3>(options, law()), Error);
}

TEST(packed_spheres, with_friction_are_looser_and_within_the_friction_limit) {
  GeneratorOptions options = hundred();
  const double smooth = summary(consolidate<3>(options, law())).void_ratio;
  options.friction = 0.5;
  const Summary s = summary(consolidate<3>(options, law()), options.friction);
  expect_pressure(s, 1e5);
  EXPECT_GT(s.void_ratio, smooth + 0.1);
  EXPECT_GT(s.sliding, 0.01);
  // Rounded places give a weak force no more digits than a strong one.
  EXPECT_LT(s.slip_excess, 1e-12);
}

TEST(packed_spheres, of_hertz_mindlin_contacts_rest_at_their_pressure) {
  ContactLaw hertz = law();
  hertz.kind = LawKind::hertz;
  hertz.shear_modulus = 1e9;
  hertz.poisson = 0.2;
  hertz.ratio = 2 * 0.8 / 1.8;
  expect_pressure(summary(consolidate<3>(hundred(), hertz)), 1e5);
}

TEST(packed_spheres, have_the_anisotropy_wanted_under_different_stresses) {
  GeneratorOptions options = hundred(3);
  options.friction = 0.5;
  options.anisotropy = 0.1;
  MaterialDescription description;
  description.packing.dimension = 3;
  description.generator = options;
  description.law = law();
  const auto material = make_material<3>(description);
  double anisotropy = 0;
  measure(material->problem(), material->initial, GRAINLAW_ANISOTROPY, &anisotropy);
  EXPECT_NEAR(anisotropy, 0.1, 0.005);
  const auto& stress = material->initial.stress;
  EXPECT_NEAR(trace<3>(stress) / 3, -1e5, 1);
  EXPECT_LT(stress[8], 0.5 * (stress[0] + stress[4]));
}

TEST(packed_spheres, have_the_same_bits_for_the_same_seed) {
  for (const auto kind : {GeneratorKind::compaction, GeneratorKind::lubachevsky_stillinger}) {
    GeneratorOptions options = hundred(5);
    options.kind = kind;
    options.friction = 0.3;
    const Packing a = consolidate<3>(options, law());
    const Packing b = consolidate<3>(options, law());
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.cell, b.cell);
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    for (std::size_t c = 0; c < a.contacts.size(); ++c) {
      EXPECT_EQ(a.contacts[c].tangential_force, b.contacts[c].tangential_force);
    }
    options.seed = 6;
    EXPECT_NE(a.position, consolidate<3>(options, law()).position);
  }
}

TEST(packed_spheres, refuse_what_cannot_be) {
  const auto refused = [](auto change) {
    GeneratorOptions options = hundred();
    change(options);
    EXPECT_THROW(consolidate<3>(options, law()), Error);
  };
  refused([](auto& o) { o.pressure = 0; });
  refused([](auto& o) { o.pressure = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& o) { o.pressure = 1e9; });
  refused([](auto& o) { o.friction = -1; });
  refused([](auto& o) { o.radius_min = 0; });
}

}  // namespace
}  // namespace grainlaw::core::sphere_test
