// The order of a graph level by level: every node once, neighbours near each other.
#include "linear/level_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace grainlaw::core::test {
namespace {

// A square lattice of nodes that are numbered by chance.
std::vector<Edge> lattice(std::size_t side, std::mt19937& random) {
  std::vector<std::int32_t> number(side * side);
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), random);
  std::vector<Edge> edges;
  const auto join = [&](std::size_t a, std::size_t b) {
    edges.push_back(std::minmax(number[a], number[b]));
  };
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      if (x + 1 < side) join(side * y + x, side * y + x + 1);
      if (y + 1 < side) join(side * y + x, side * (y + 1) + x);
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::int32_t widest(const LevelOrder& order, const std::vector<Edge>& edges) {
  std::int32_t result = 0;
  for (const auto& [p, q] : edges) {
    const std::int32_t distance =
        order.place()[static_cast<std::size_t>(p)] - order.place()[static_cast<std::size_t>(q)];
    result = std::max(result, std::abs(distance));
  }
  return result;
}

TEST(level_order, has_every_node_once) {
  LevelOrder order;  // of one graph after the other
  std::mt19937 random(41);
  for (const std::size_t side : {7U, 1U, 12U, 3U}) {
    order.find(side * side + 2, lattice(side, random));  // two nodes without neighbours
    std::vector<std::int32_t> nodes(order.node().begin(), order.node().end());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      EXPECT_EQ(order.place()[static_cast<std::size_t>(nodes[k])], static_cast<std::int32_t>(k));
    }
    std::sort(nodes.begin(), nodes.end());
    ASSERT_EQ(nodes.size(), side * side + 2);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      EXPECT_EQ(nodes[k], static_cast<std::int32_t>(k));
    }
  }
}

// A level of a lattice of side n has at most 2 n nodes, and neighbours are at most a level apart.
TEST(level_order, keeps_neighbours_near_each_other) {
  constexpr std::size_t side = 20;
  std::mt19937 random(42);
  const auto edges = lattice(side, random);
  LevelOrder order;
  order.find(side * side, edges);
  EXPECT_LE(widest(order, edges), 4 * static_cast<std::int32_t>(side));
}

}  // namespace
}  // namespace grainlaw::core::test
