#include "generate/compaction.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainlaw::core {
namespace {

GeneratorOptions small() {
  GeneratorOptions options;
  options.count = 80;
  return options;
}

ContactLaw law() {
  ContactLaw law;
  law.young = 6e8;
  law.ratio = 0.8;
  law.friction = 0.5;
  return law;
}

struct Summary {
  std::array<double, 4> stress{};  // Cauchy [Pa]
  double void_ratio = 0;
  double unbalanced = 0;  // largest component of a particle's force / mean normal force [-]
  double sliding = 0;     // largest |ft| / fn [-]
};

// From the packing's own contact forces alone.
Summary summary(const Packing& packing) {
  Summary s;
  const std::size_t n = packing.size();
  const auto& h = packing.cell;
  const double volume = h[0] * h[3] * packing.thickness;
  std::vector<double> force(2 * n, 0.0);
  double mean = 0;
  for (const InitialContact& c : packing.contacts) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const double l[2] = {packing.position[j] - packing.position[i] + h[0] * c.shift[0],
                         packing.position[n + j] - packing.position[n + i] + h[3] * c.shift[1]};
    const double d = std::hypot(l[0], l[1]);
    mean += c.normal_force / static_cast<double>(packing.contacts.size());
    s.sliding = std::max(s.sliding,
                         std::hypot(c.tangential_force[0], c.tangential_force[1]) / c.normal_force);
    for (std::size_t a = 0; a < 2; ++a) {
      const double f = c.normal_force * l[a] / d + c.tangential_force[a];
      force[a * n + j] += f;
      force[a * n + i] -= f;
      for (std::size_t b = 0; b < 2; ++b) s.stress[2 * a + b] -= f * l[b] / volume;
    }
  }
  for (const double f : force) s.unbalanced = std::max(s.unbalanced, std::abs(f) / mean);
  double solid = 0;
  for (const double r : packing.radius) solid += std::numbers::pi * r * r;
  s.void_ratio = h[0] * h[3] / solid - 1;
  return s;
}

TEST(compaction, reaches_the_pressure_at_rest) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    GeneratorOptions options = small();
    options.seed = seed;
    const Packing packing = consolidate(options, law());
    const Summary s = summary(packing);
    EXPECT_NEAR(s.stress[0], -1e5, 0.1);
    EXPECT_NEAR(s.stress[3], -1e5, 0.1);
    EXPECT_NEAR(s.stress[1], s.stress[2], 1e-3);
    EXPECT_LT(s.unbalanced, 1e-8);
    EXPECT_EQ(s.sliding, 0);
    EXPECT_EQ(packing.cell[1], 0);
    EXPECT_EQ(packing.cell[2], 0);
    EXPECT_NEAR(s.void_ratio, 0.175, 0.03);
  }
}

TEST(compaction, reaches_the_void_ratio_with_equal_stresses) {
  GeneratorOptions options = small();
  options.void_ratio = 0.15;
  const Summary s = summary(consolidate(options, law()));
  EXPECT_NEAR(s.void_ratio, 0.15, 1e-9);
  EXPECT_LT(s.stress[0], -1e4);
  EXPECT_NEAR(s.stress[0] / s.stress[3], 1, 1e-6);
  EXPECT_LT(s.unbalanced, 1e-8);
}

TEST(compaction, with_friction_is_looser_and_within_the_friction_limit) {
  GeneratorOptions options = small();
  const double smooth = summary(consolidate(options, law())).void_ratio;
  options.friction = 0.5;
  const Summary s = summary(consolidate(options, law()));
  EXPECT_GT(s.void_ratio, smooth + 0.02);
  EXPECT_GT(s.sliding, 0.01);
  EXPECT_LT(s.sliding, 0.5 * (1 + 1e-12));
  EXPECT_NEAR(s.stress[0], -1e5, 0.1);
  EXPECT_LT(s.unbalanced, 1e-8);
}

TEST(compaction, gives_the_same_bits_again) {
  const Packing a = consolidate(small(), law());
  const Packing b = consolidate(small(), law());
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.contacts.size(), b.contacts.size());
}

TEST(compaction, refuses_what_cannot_be) {
  GeneratorOptions options = small();
  options.void_ratio = 0.4;
  EXPECT_THROW(consolidate(options, law()), Error);
  options = small();
  options.pressure = 0;
  EXPECT_THROW(consolidate(options, law()), Error);
  options.pressure = std::nan("");
  EXPECT_THROW(consolidate(options, law()), Error);
  options = small();
  options.friction = -1;
  EXPECT_THROW(consolidate(options, law()), Error);
}

}  // namespace
}  // namespace grainlaw::core
