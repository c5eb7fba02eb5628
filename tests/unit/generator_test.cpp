#include "generate/generator.hpp"

#include "base/error.hpp"
#include "packing/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainlaw::core {
namespace {

TEST(generator, scatters_discs_that_do_not_touch) {
  for (const std::size_t count : {1U, 2U, 3U, 10U, 400U, 3000U}) {
    GeneratorOptions options;
    options.count = count;
    options.seed = count;
    const Packing packing = scatter(options);
    ASSERT_EQ(packing.size(), count);
    std::vector<NeighbourPair<2>> pairs;
    NeighbourSearch<2>().find(count, packing.position.data(), packing.radius.data(),
                              packing.cell.data(), 0, pairs);
    EXPECT_TRUE(pairs.empty());
    double solid = 0;
    for (const double r : packing.radius) solid += std::numbers::pi * r * r;
    EXPECT_NEAR(solid / (packing.cell[0] * packing.cell[3]), 0.4, 1e-12);
  }
}

TEST(generator, gives_every_seed_the_same_grading_and_other_places) {
  GeneratorOptions options;
  Packing first = scatter(options);
  const Packing again = scatter(options);
  EXPECT_EQ(first.position, again.position);
  EXPECT_EQ(first.radius, again.radius);
  options.seed = 2;
  Packing second = scatter(options);
  EXPECT_NE(first.position, second.position);
  EXPECT_NE(first.radius, second.radius);
  std::sort(first.radius.begin(), first.radius.end());
  std::sort(second.radius.begin(), second.radius.end());
  EXPECT_EQ(first.radius, second.radius);
  EXPECT_DOUBLE_EQ(first.radius.front(), 3e-3 + 4e-3 * 0.5 / 400);
  EXPECT_DOUBLE_EQ(first.radius.back(), 7e-3 - 4e-3 * 0.5 / 400);
}

TEST(generator, bits_are_those_of_the_first_release) {
  GeneratorOptions options;
  options.count = 5;
  options.seed = 42;
  const Packing packing = scatter(options);
  EXPECT_EQ(packing.radius[0], 0.0042000000000000006);
  EXPECT_EQ(packing.position[0], 0.0095613514621784093);
  EXPECT_EQ(packing.position[9], 0.011979003193885486);
}

TEST(generator, makes_discs_of_one_size) {
  GeneratorOptions options;
  options.radius_min = options.radius_max = 1;
  const Packing packing = scatter(options);
  EXPECT_EQ(packing.radius, std::vector<double>(400, 1.0));
}

TEST(generator, refuses_options_out_of_range) {
  const auto refused = [](auto change) {
    GeneratorOptions options;
    change(options);
    EXPECT_THROW(scatter(options), Error);
  };
  refused([](auto& o) { o.count = 0; });
  refused([](auto& o) { o.radius_min = 0; });
  refused([](auto& o) { o.radius_max = 1e-3; });
  refused([](auto& o) { o.radius_max = std::nan(""); });
  refused([](auto& o) { o.thickness = -1; });
  refused([](auto& o) { o.density = 0; });
}

}  // namespace
}  // namespace grainlaw::core
