#include "packing/neighbours.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace grainlaw::core {
namespace {

struct Discs {
  std::vector<double> position, radius;
};

// n discs in the cell, wrapped `far` cells away at random.
Discs random_discs(std::size_t n, const std::array<double, 4>& h, double radius_max, int far,
                   std::mt19937_64& rng) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<int> cells(-far, far);
  Discs discs{std::vector<double>(2 * n), std::vector<double>(n)};
  for (std::size_t p = 0; p < n; ++p) {
    const double s0 = unit(rng) + cells(rng);
    const double s1 = unit(rng) + cells(rng);
    discs.position[p] = h[0] * s0 + h[1] * s1;
    discs.position[n + p] = h[2] * s0 + h[3] * s1;
    discs.radius[p] = radius_max * (0.4 + 0.6 * unit(rng));
  }
  return discs;
}

// Every shift that could matter, each pair tried: the definition, and slow.
std::vector<NeighbourPair<2>> brute_force(const Discs& discs, const double* h, double gap) {
  const std::size_t n = discs.radius.size();
  std::vector<NeighbourPair<2>> pairs;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const double dx = discs.position[j] - discs.position[i];
      const double dy = discs.position[n + j] - discs.position[n + i];
      const double limit = discs.radius[i] + discs.radius[j] + gap;
      if (h == nullptr) {
        if (i != j && std::hypot(dx, dy) < limit)
          pairs.push_back({static_cast<int>(i), static_cast<int>(j), {0, 0}});
        continue;
      }
      const double area = h[0] * h[3] - h[1] * h[2];
      const double s0 = -(h[3] * dx - h[1] * dy) / area;
      const double s1 = -(h[0] * dy - h[2] * dx) / area;
      const double reach0 = limit * std::hypot(h[1], h[3]) / std::abs(area) + 1;
      const double reach1 = limit * std::hypot(h[0], h[2]) / std::abs(area) + 1;
      for (double a = std::floor(s0 - reach0); a <= s0 + reach0; ++a)
        for (double b = std::floor(s1 - reach1); b <= s1 + reach1; ++b) {
          if (i == j && !(a > 0 || (a == 0 && b > 0))) continue;
          if (std::hypot(dx + h[0] * a + h[1] * b, dy + h[2] * a + h[3] * b) < limit)
            pairs.push_back({static_cast<int>(i),
                             static_cast<int>(j),
                             {static_cast<std::int16_t>(a), static_cast<std::int16_t>(b)}});
        }
    }
  return pairs;
}

void expect_as_brute_force(const Discs& discs, const double* cell, double gap) {
  NeighbourSearch<2> search;
  std::vector<NeighbourPair<2>> pairs;
  search.find(discs.radius.size(), discs.position.data(), discs.radius.data(), cell, gap, pairs);
  EXPECT_EQ(pairs, brute_force(discs, cell, gap));
}

const std::array<double, 4> square = {1, 0, 0, 1};
const std::array<double, 4> sheared = {1, 2.7, 0, 0.9};
const std::array<double, 4> sheared_back = {1.1, -0.3, -4.2, 1.4};
const std::array<double, 4> rotated = {-0.2, -1.1, 1.3, -0.1};

TEST(neighbours, agree_with_brute_force_in_any_cell) {
  std::mt19937_64 rng(1);
  for (const auto& cell : {square, sheared, sheared_back, rotated})
    for (const std::size_t n : {1U, 2U, 7U, 40U, 300U})
      for (const double gap : {0.0, 0.03, 0.4})
        expect_as_brute_force(random_discs(n, cell, 0.06, 0, rng), cell.data(), gap);
}

TEST(neighbours, of_a_cell_smaller_than_a_particle_come_with_all_images) {
  std::mt19937_64 rng(2);
  for (const auto& cell : {square, sheared, sheared_back, rotated})
    for (const std::size_t n : {1U, 2U, 3U})
      for (const double radius : {0.3, 0.8, 2.1})
        expect_as_brute_force(random_discs(n, cell, radius, 0, rng), cell.data(), 0.1);
}

TEST(neighbours, of_a_cell_far_thinner_than_a_particle_are_refused) {
  const Discs disc{{0, 0}, {40}};
  std::vector<NeighbourPair<2>> pairs;
  EXPECT_THROW(NeighbourSearch<2>().find(1, disc.position.data(), disc.radius.data(), square.data(),
                                         0, pairs),
               Error);
}

TEST(neighbours, are_found_from_unwrapped_positions) {
  std::mt19937_64 rng(3);
  for (const auto& cell : {square, sheared, rotated})
    for (const int far : {1, 5, 4000})
      expect_as_brute_force(random_discs(60, cell, 0.08, far, rng), cell.data(), 0.02);
}

TEST(neighbours, without_a_cell_have_no_images) {
  std::mt19937_64 rng(4);
  for (const std::size_t n : {1U, 2U, 5U, 200U})
    expect_as_brute_force(random_discs(n, sheared, 0.07, 1, rng), nullptr, 0.05);
}

TEST(neighbours, of_discs_on_one_line_or_point_are_found) {
  Discs line{{0, 0.5, 1, 1.5, 3, 3, 3, 3}, {0.3, 0.3, 0.2, 0.6}};
  expect_as_brute_force(line, nullptr, 0);
  Discs point{{1, 1, 1, 1}, {0.3, 0.3}};
  expect_as_brute_force(point, nullptr, 0);
  expect_as_brute_force(point, square.data(), 0);
}

TEST(neighbours, of_very_unequal_discs_are_found) {
  std::mt19937_64 rng(5);
  Discs discs = random_discs(200, square, 0.01, 0, rng);
  discs.radius[17] = 0.9;
  expect_as_brute_force(discs, square.data(), 0.01);
  expect_as_brute_force(discs, nullptr, 0.01);
  for (const auto& cell : {square, sheared, sheared_back, rotated}) {
    Discs steps = random_discs(200, cell, 0.01, 3, rng);
    steps.radius[3] = 0.3;  // alone, a few, and some between them and the rest
    for (const std::size_t p : {40U, 41U, 199U}) steps.radius[p] = 0.1;
    for (std::size_t p = 100; p < 130; ++p) steps.radius[p] = 0.03;
    for (const double gap : {0.0, 0.02}) {
      expect_as_brute_force(steps, cell.data(), gap);
      expect_as_brute_force(steps, nullptr, gap);
    }
  }
}

// One disc of twenty radii among four thousand: no more than a few candidates for each of the rest.
TEST(neighbours, of_one_large_disc_among_many_take_little_more_work_than_without_it) {
  std::mt19937_64 rng(7);
  NeighbourSearch<2> search;
  std::vector<NeighbourPair<2>> pairs;
  const auto candidates_of = [&](const Discs& discs) {
    search.find(discs.radius.size(), discs.position.data(), discs.radius.data(), square.data(),
                1e-3, pairs);
    return search.candidates();
  };
  Discs discs = random_discs(4000, square, 0.01, 0, rng);
  const std::size_t without = candidates_of(discs);
  EXPECT_GE(without, 2 * pairs.size());  // each pair is met from both sides
  discs.radius[17] = 0.2;
  EXPECT_LT(candidates_of(discs), 3 * without);
}

TEST(neighbours, are_the_same_when_the_search_is_reused) {
  std::mt19937_64 rng(6);
  NeighbourSearch<2> search;
  std::vector<NeighbourPair<2>> pairs;
  for (const std::size_t n : {100U, 3U, 250U, 1U}) {
    const Discs discs = random_discs(n, sheared, 0.1, 2, rng);
    search.find(n, discs.position.data(), discs.radius.data(), sheared.data(), 0.02, pairs);
    EXPECT_EQ(pairs, brute_force(discs, sheared.data(), 0.02));
  }
}

TEST(neighbours, refuse_what_has_no_answer) {
  NeighbourSearch<2> search;
  std::vector<NeighbourPair<2>> pairs;
  const auto find = [&](Discs discs, const double* cell) {
    search.find(discs.radius.size(), discs.position.data(), discs.radius.data(), cell, 0, pairs);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double flat[4] = {1, 2, 1, 2};
  EXPECT_THROW(find({{0, nan, 0, 0}, {0.1, 0.1}}, square.data()), Error);
  EXPECT_THROW(find({{0, nan, 0, 0}, {0.1, 0.1}}, nullptr), Error);
  EXPECT_THROW(find({{0, 1e300, 0, 0}, {0.1, 0.1}}, square.data()), Error);
  EXPECT_THROW(find({{0, 40000, 0, 0}, {0.1, 0.1}}, square.data()), Error);
  EXPECT_THROW(find({{0, 1, 0, 0}, {0.1, 0.1}}, flat), Error);
  EXPECT_NO_THROW(find({{}, {}}, square.data()));
}

struct Spheres {
  std::vector<double> position, radius;
};

using Cell3 = std::array<double, 9>;

Eigen::Matrix3d matrix_of(const Cell3& h) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(h.data());
}

// n spheres in the cell, wrapped `far` cells away at random.
Spheres random_spheres(std::size_t n, const Cell3& h, double radius_max, int far,
                       std::mt19937_64& rng) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<int> cells(-far, far);
  Spheres spheres{std::vector<double>(3 * n), std::vector<double>(n)};
  for (std::size_t p = 0; p < n; ++p) {
    Eigen::Vector3d s;
    for (double& value : s) value = unit(rng) + cells(rng);
    const Eigen::Vector3d x = matrix_of(h) * s;
    for (std::size_t k = 0; k < 3; ++k) {
      spheres.position[k * n + p] = x[static_cast<Eigen::Index>(k)];
    }
    spheres.radius[p] = radius_max * (0.4 + 0.6 * unit(rng));
  }
  return spheres;
}

Eigen::Vector3d place(const Spheres& spheres, std::size_t p) {
  const std::size_t n = spheres.radius.size();
  return {spheres.position[p], spheres.position[n + p], spheres.position[2 * n + p]};
}

// Every pair tried with every shift that could matter; in the order (i, j, shift).
std::vector<NeighbourPair<3>> brute_force(const Spheres& spheres, const Cell3* h, double gap) {
  const std::size_t n = spheres.radius.size();
  const Eigen::Matrix3d cell = h != nullptr ? matrix_of(*h) : Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d inverse = cell.inverse();
  std::vector<NeighbourPair<3>> pairs;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      const Eigen::Vector3d apart = place(spheres, j) - place(spheres, i);
      const double limit = spheres.radius[i] + spheres.radius[j] + gap;
      NeighbourPair<3> pair{static_cast<int>(i), static_cast<int>(j), {}};
      if (h == nullptr) {
        if (i != j && apart.norm() < limit) pairs.push_back(pair);
        continue;
      }
      const Eigen::Vector3d centre = -inverse * apart;
      const Eigen::Vector3d reach = (limit * inverse.rowwise().norm()).array() + 1;
      const Eigen::Vector3d first = (centre - reach).array().floor();
      const Eigen::Vector3d last = centre + reach;
      for (double a = first[0]; a <= last[0]; ++a)
        for (double b = first[1]; b <= last[1]; ++b)
          for (double c = first[2]; c <= last[2]; ++c) {
            pair.shift = {static_cast<std::int16_t>(a), static_cast<std::int16_t>(b),
                          static_cast<std::int16_t>(c)};
            if (i == j && !(pair.shift > decltype(pair.shift){})) continue;
            if ((apart + cell * Eigen::Vector3d(a, b, c)).norm() < limit) pairs.push_back(pair);
          }
    }
  return pairs;
}

void expect_as_brute_force(const Spheres& spheres, const Cell3* cell, double gap) {
  NeighbourSearch<3> search;
  std::vector<NeighbourPair<3>> pairs;
  search.find(spheres.radius.size(), spheres.position.data(), spheres.radius.data(),
              cell != nullptr ? cell->data() : nullptr, gap, pairs);
  EXPECT_EQ(pairs, brute_force(spheres, cell, gap));
}

const Cell3 cube = {1, 0, 0, 0, 1, 0, 0, 0, 1};
const Cell3 sheared_cube = {1, 2.3, -0.7, 0, 0.9, 1.6, 0, 0, 1.2};
const Cell3 oblique = {1.1, -0.3, 0.4, -1.2, 1.4, 0.2, 0.3, 0.8, 1.3};
const Cell3 mirrored = {-0.2, -1.1, 0.1, 1.3, -0.1, 0.2, 0.1, 0.3, -1};

TEST(neighbours, of_spheres_agree_with_brute_force_in_any_cell) {
  std::mt19937_64 rng(8);
  for (const auto& cell : {cube, sheared_cube, oblique, mirrored})
    for (const std::size_t n : {1U, 2U, 7U, 40U, 200U})
      for (const double gap : {0.0, 0.03, 0.4})
        expect_as_brute_force(random_spheres(n, cell, 0.12, 0, rng), &cell, gap);
}

TEST(neighbours, of_a_cell_smaller_than_a_sphere_come_with_all_images) {
  std::mt19937_64 rng(9);
  for (const auto& cell : {cube, sheared_cube, oblique, mirrored})
    for (const std::size_t n : {1U, 2U, 3U})
      for (const double radius : {0.3, 0.8, 2.1})
        expect_as_brute_force(random_spheres(n, cell, radius, 0, rng), &cell, 0.1);
}

TEST(neighbours, of_spheres_are_found_from_unwrapped_positions) {
  std::mt19937_64 rng(10);
  for (const auto& cell : {cube, sheared_cube, oblique, mirrored})
    for (const int far : {1, 5, 200})
      expect_as_brute_force(random_spheres(60, cell, 0.15, far, rng), &cell, 0.02);
}

TEST(neighbours, of_spheres_without_a_cell_have_no_images) {
  std::mt19937_64 rng(11);
  for (const std::size_t n : {1U, 2U, 5U, 200U})
    expect_as_brute_force(random_spheres(n, oblique, 0.15, 1, rng), nullptr, 0.05);
}

TEST(neighbours, of_very_unequal_spheres_are_found) {
  std::mt19937_64 rng(12);
  for (const auto& cell : {cube, sheared_cube, oblique, mirrored}) {
    Spheres steps = random_spheres(150, cell, 0.02, 1, rng);
    steps.radius[3] = 0.5;  // alone, a few, and some between them and the rest
    for (const std::size_t p : {40U, 41U, 149U}) steps.radius[p] = 0.2;
    for (std::size_t p = 100; p < 120; ++p) steps.radius[p] = 0.06;
    for (const double gap : {0.0, 0.02}) {
      expect_as_brute_force(steps, &cell, gap);
      expect_as_brute_force(steps, nullptr, gap);
    }
  }
}

TEST(neighbours, of_spheres_come_in_order_each_once) {
  std::mt19937_64 rng(13);
  NeighbourSearch<3> search;  // of one packing after the other
  std::vector<NeighbourPair<3>> pairs;
  for (const auto& cell : {cube, sheared_cube, oblique, mirrored})
    for (const auto& [n, radius] : {std::pair{2, 1.5}, std::pair{90, 0.2}, std::pair{30, 0.5}}) {
      const Spheres spheres = random_spheres(static_cast<std::size_t>(n), cell, radius, 3, rng);
      search.find(spheres.radius.size(), spheres.position.data(), spheres.radius.data(),
                  cell.data(), 0.02, pairs);
      ASSERT_GT(pairs.size(), spheres.radius.size());
      for (std::size_t c = 0; c < pairs.size(); ++c) {
        EXPECT_LE(pairs[c].i, pairs[c].j);
        if (c == 0) continue;
        EXPECT_LT(key_of(pairs[c - 1]), key_of(pairs[c]));
      }
      EXPECT_EQ(pairs, brute_force(spheres, &cell, 0.02));
    }
}

TEST(neighbours, of_spheres_refuse_what_has_no_answer) {
  NeighbourSearch<3> search;
  std::vector<NeighbourPair<3>> pairs;
  const auto find = [&](const Spheres& spheres, const Cell3& cell) {
    search.find(spheres.radius.size(), spheres.position.data(), spheres.radius.data(), cell.data(),
                0, pairs);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Cell3 flat = {1, 0, 1, 0, 1, 1, 0, 0, 0};
  EXPECT_THROW(find({{0, 0, 0, 0, 0, nan}, {0.1, 0.1}}, cube), Error);
  EXPECT_THROW(find({{0, 0, 0, 0, 0, 1e300}, {0.1, 0.1}}, cube), Error);
  EXPECT_THROW(find({{0, 0, 0, 0, 0, 600}, {0.1, 0.1}}, cube), Error);
  EXPECT_THROW(find({{0, 0, 0, 0, 0, 1}, {0.1, 0.1}}, flat), Error);
  EXPECT_NO_THROW(find({{}, {}}, cube));
}

}  // namespace
}  // namespace grainlaw::core
