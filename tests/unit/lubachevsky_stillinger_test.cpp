#include "generate/lubachevsky_stillinger.hpp"

#include "base/error.hpp"
#include "generate/compaction.hpp"
#include "packing/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainlaw::core {
namespace {

GeneratorOptions options(std::size_t count, std::uint64_t seed = 1) {
  GeneratorOptions options;
  options.kind = GeneratorKind::lubachevsky_stillinger;
  options.count = count;
  options.radius_min = 0.67e-3;
  options.radius_max = 1.34e-3;
  options.seed = seed;
  return options;
}

double volume_fraction(const Packing& packing) {
  double solid = 0;
  for (const double r : packing.radius) solid += std::numbers::pi * r * r;
  return solid / (packing.cell[0] * packing.cell[3]);
}

std::size_t pairs_within(const Packing& packing, double gap) {
  std::vector<NeighbourPair<2>> pairs;
  NeighbourSearch<2>().find(packing.size(), packing.position.data(), packing.radius.data(),
                            packing.cell.data(), gap, pairs);
  return pairs.size();
}

TEST(lubachevsky_stillinger, jams_near_random_close_packing_without_overlaps) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Packing packing = grow(options(100, seed));
    EXPECT_EQ(pairs_within(packing, 0), 0U);
    EXPECT_NEAR(volume_fraction(packing), 0.843, 0.015);
    // Nearly isostatic: about two contacts per disc that bears load, gaps far below a radius.
    EXPECT_GT(pairs_within(packing, 1e-3 * 1e-3), 150U);
    EXPECT_LT(pairs_within(packing, 1e-3 * 1e-3), 200U);
  }
}

TEST(lubachevsky_stillinger, ends_at_the_volume_fraction_wanted) {
  for (const double wanted : {0.4, 0.6, 0.8}) {
    GeneratorOptions o = options(60);
    o.growth_end = wanted;
    const Packing packing = grow(o);
    EXPECT_NEAR(volume_fraction(packing), wanted, 1e-9);
    EXPECT_EQ(pairs_within(packing, 0), 0U);
  }
}

TEST(lubachevsky_stillinger, grows_few_discs_and_very_different_ones) {
  for (const std::size_t count : {2U, 3U, 4U, 7U, 12U}) {
    const Packing packing = grow(options(count));
    EXPECT_EQ(pairs_within(packing, 0), 0U) << count;
    EXPECT_GT(volume_fraction(packing), 0.55) << count;
  }
  GeneratorOptions o = options(60);
  o.radius_max = 10 * o.radius_min;
  const Packing packing = grow(o);
  EXPECT_EQ(pairs_within(packing, 0), 0U);
  EXPECT_GT(volume_fraction(packing), 0.8);
}

// Slow growth of equal discs lets them order; fast growth freezes them as they are.
TEST(lubachevsky_stillinger, faster_growth_jams_looser) {
  GeneratorOptions slow = options(64);
  slow.radius_min = slow.radius_max = 1e-3;
  slow.growth_rate = 3e-3;
  GeneratorOptions fast = slow;
  fast.growth_rate = 1;
  EXPECT_GT(volume_fraction(grow(slow)), volume_fraction(grow(fast)) + 0.01);
}

TEST(lubachevsky_stillinger, gives_the_same_bits_for_the_same_seed) {
  const Packing a = grow(options(50, 7));
  const Packing b = grow(options(50, 7));
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_NE(a.position, grow(options(50, 8)).position);
}

TEST(lubachevsky_stillinger, refuses_what_cannot_be) {
  const auto refused = [](auto change) {
    GeneratorOptions o = options(30);
    change(o);
    EXPECT_THROW(grow(o), Error);
  };
  refused([](auto& o) { o.count = 1; });
  refused([](auto& o) { o.growth_rate = 0; });
  refused([](auto& o) { o.growth_rate = NAN; });
  refused([](auto& o) { o.growth_end = 0.2; });
  refused([](auto& o) { o.growth_end = 0.93; });
  refused([](auto& o) { o.radius_min = -1; });
}

}  // namespace
}  // namespace grainlaw::core
