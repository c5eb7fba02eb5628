// Particles in an order in which neighbours are near each other in memory.
#include "packing/row_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

namespace grainlaw::core {
namespace {

// side x side discs of unit distance, numbered at random, in a cell sheared by its own height; some
// lie cells away.
Packing shuffled_grid(std::size_t side) {
  std::mt19937_64 rng(1);
  std::uniform_int_distribution<int> cells(-2, 2);
  const std::size_t n = side * side;
  const auto length = static_cast<double>(side);
  std::vector<std::size_t> place(n);
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::shuffle(place.begin(), place.end(), rng);
  Packing packing;
  packing.cell = {length, length, 0, length};
  packing.radius.assign(n, 0.5);
  packing.position.resize(2 * n);
  for (std::size_t p = 0; p < n; ++p) {
    const double s = static_cast<double>(place[p] % side) / length + cells(rng);
    const double t = (static_cast<double>(place[p] / side) + 0.5) / length + cells(rng);
    packing.position[p] = length * (s + t);
    packing.position[n + p] = length * t;
  }
  return packing;
}

// Distance along one axis of a periodic length.
double periodic(double distance, double length) {
  return std::abs(distance - length * std::round(distance / length));
}

TEST(row_order, has_every_particle_once_with_its_neighbours_next_to_it) {
  constexpr std::size_t side = 40;
  const Packing packing = shuffled_grid(side);
  auto order = row_order(packing);
  ASSERT_EQ(order.size(), packing.size());
  for (std::size_t q = 1; q < order.size(); ++q) {
    const auto a = static_cast<std::size_t>(order[q - 1]);
    const auto b = static_cast<std::size_t>(order[q]);
    const double y = packing.position[side * side + b] - packing.position[side * side + a];
    const double x = packing.position[b] - packing.position[a] - y;  // along the rows
    EXPECT_LE(periodic(y, side), 3 + 1e-9) << q;
    EXPECT_LE(periodic(x, side), 1 + 1e-9) << q;
  }
  std::sort(order.begin(), order.end());
  for (std::size_t p = 0; p < order.size(); ++p) EXPECT_EQ(order[p], static_cast<std::int32_t>(p));
}

TEST(row_order, is_left_out_for_small_packings) {
  EXPECT_TRUE(row_order(shuffled_grid(32)).empty());
}

}  // namespace
}  // namespace grainlaw::core
