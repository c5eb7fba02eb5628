// The block factorisation and GMRES against a dense factorisation, on random matrices over random
// planar graphs.
#include "linear/block_lu.hpp"
#include "linear/block_matrix.hpp"
#include "linear/gmres.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace grainlaw {
namespace {

// Points in a square, joined when near: as planar as the contacts of discs.
std::vector<Edge> near_pairs(std::size_t nodes, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> x(nodes);
  std::vector<double> y(nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    x[q] = uniform(random);
    y[q] = uniform(random);
  }
  const double reach = 1.3 / std::sqrt(static_cast<double>(nodes));
  std::vector<Edge> edges;
  for (std::size_t p = 0; p < nodes; ++p) {
    for (std::size_t q = p + 1; q < nodes; ++q) {
      if (std::hypot(x[p] - x[q], y[p] - y[q]) > reach) continue;
      edges.emplace_back(static_cast<std::int32_t>(p), static_cast<std::int32_t>(q));
    }
  }
  return edges;
}

// Non-symmetric values; diagonal blocks that outweigh the others, as stiffness does.
void fill(BlockMatrix& matrix, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto b = static_cast<std::size_t>(matrix.components);
  for (Quad& column : matrix.blocks) {
    for (std::size_t row = 0; row < b; ++row) column.lane[row] = uniform(random);
  }
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) matrix.block(q)[k].lane[k] += 6;
  }
}

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const auto nodes = static_cast<Eigen::Index>(matrix.nodes);
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(matrix.components * nodes, matrix.components * nodes);
  const auto add = [&](std::size_t index, Eigen::Index row, Eigen::Index column) {
    for (int c = 0; c < matrix.components; ++c) {
      for (int r = 0; r < matrix.components; ++r) {
        result(r * nodes + row, c * nodes + column) = matrix.block(index)[c].lane[r];
      }
    }
  };
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    add(q, static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(q));
  }
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    const auto [p, q] = matrix.edges[e];
    add(matrix.upper(e), p, q);
    add(matrix.lower(e), q, p);
  }
  return result;
}

std::vector<double> random_vector(std::size_t size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> values(size);
  for (double& value : values) value = uniform(random);
  return values;
}

// One quad per node.
std::vector<Quad> by_node(const BlockMatrix& matrix, const std::vector<double>& values) {
  std::vector<Quad> result(matrix.nodes);
  for (std::size_t k = 0; k < values.size(); ++k) {
    result[k % matrix.nodes].lane[k / matrix.nodes] = values[k];
  }
  return result;
}

std::vector<double> by_component(const BlockMatrix& matrix, const std::vector<Quad>& values) {
  std::vector<double> result(matrix.nodes * static_cast<std::size_t>(matrix.components));
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = values[k % matrix.nodes].lane[k / matrix.nodes];
  }
  return result;
}

std::vector<double> solve(BlockLU& lu, const BlockMatrix& matrix, const std::vector<double>& b) {
  auto x = by_node(matrix, b);
  lu.solve(x);
  return by_component(matrix, x);
}

// Vector l in lane l: one quad per node and component.
std::vector<Quad> together(const BlockMatrix& matrix,
                           const std::array<std::vector<double>, 4>& vectors) {
  const auto b = static_cast<std::size_t>(matrix.components);
  std::vector<Quad> result(matrix.nodes * b);
  for (std::size_t l = 0; l < 4; ++l) {
    for (std::size_t k = 0; k < result.size(); ++k) {
      result[k % matrix.nodes * b + k / matrix.nodes].lane[l] = vectors[l][k];
    }
  }
  return result;
}

std::vector<double> lane(const BlockMatrix& matrix, const std::vector<Quad>& vectors,
                         std::size_t l) {
  const auto b = static_cast<std::size_t>(matrix.components);
  std::vector<double> result(vectors.size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = vectors[k % matrix.nodes * b + k / matrix.nodes].lane[l];
  }
  return result;
}

Eigen::VectorXd as_eigen(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Largest entry of b - A x over that of b.
double defect(const BlockMatrix& matrix, const std::vector<double>& b,
              const std::vector<double>& x) {
  return (as_eigen(b) - dense(matrix) * as_eigen(x)).lpNorm<Eigen::Infinity>() /
         as_eigen(b).lpNorm<Eigen::Infinity>();
}

void expect_solution(const BlockMatrix& matrix, const std::vector<double>& b,
                     const std::vector<double>& x) {
  const Eigen::VectorXd expected = dense(matrix).partialPivLu().solve(as_eigen(b));
  EXPECT_LE((as_eigen(x) - expected).norm(), 1e-10 * expected.norm());
}

BlockMatrix random_matrix(std::size_t nodes, int components, std::mt19937& random) {
  BlockMatrix matrix;
  matrix.reset(nodes, components, near_pairs(nodes, random));
  fill(matrix, random);
  return matrix;
}

std::size_t unknowns(const BlockMatrix& matrix) {
  return matrix.nodes * static_cast<std::size_t>(matrix.components);
}

void expect_solved(const BlockMatrix& matrix, BlockLU& lu, std::mt19937& random) {
  lu.analyse(matrix);
  ASSERT_TRUE(lu.factorise(matrix));
  const auto b = random_vector(unknowns(matrix), random);
  expect_solution(matrix, b, solve(lu, matrix, b));
}

TEST(block_lu, solves_as_a_dense_factorisation_does) {
  std::mt19937 random(11);
  BlockLU lu;  // of one matrix after the other
  for (const int components : {2, 3}) {
    for (const std::size_t nodes : {1U, 2U, 10U, 60U, 200U}) {
      expect_solved(random_matrix(nodes, components, random), lu, random);
    }
  }
}

// Groups of nodes that all touch each other, one after the other; `shared` of each are the next one's too.
BlockMatrix chained_groups(std::size_t groups, std::size_t size, std::size_t shared, int components,
                           std::mt19937& random) {
  std::set<Edge> edges;
  const std::size_t step = size - shared;
  for (std::size_t g = 0; g < groups; ++g) {
    for (std::size_t p = g * step; p < g * step + size; ++p) {
      for (std::size_t q = p + 1; q < g * step + size; ++q) {
        edges.emplace(static_cast<std::int32_t>(p), static_cast<std::int32_t>(q));
      }
    }
  }
  BlockMatrix matrix;
  const std::vector<Edge> ordered(edges.begin(), edges.end());
  matrix.reset(groups * step + shared, components, ordered);
  fill(matrix, random);
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(components); ++k) {
      matrix.block(q)[k].lane[k] += static_cast<double>(size);
    }
  }
  return matrix;
}

// 8 nodes of 3 unknowns and 12 of 2 fill a block of pivots.
TEST(block_lu, eliminates_fronts_of_any_size) {
  std::mt19937 random(21);
  BlockLU lu;  // of one matrix after the other
  for (const int components : {2, 3}) {
    for (const std::size_t size : {3U, 7U, 8U, 9U, 12U, 13U, 17U, 40U}) {
      expect_solved(chained_groups(1, size, 0, components, random), lu, random);
      for (const std::size_t shared : {std::size_t{1}, size / 2}) {
        expect_solved(chained_groups(4, size, shared, components, random), lu, random);
      }
    }
  }
}

TEST(block_lu, solves_parts_that_do_not_touch) {
  std::mt19937 random(22);
  BlockLU lu;
  for (const int components : {2, 3}) {
    expect_solved(chained_groups(5, 6, 0, components, random), lu, random);
    expect_solved(chained_groups(30, 1, 0, components, random), lu, random);
  }
}

TEST(block_lu, analysis_serves_other_values_on_the_same_graph) {
  std::mt19937 random(12);
  for (const int components : {2, 3}) {
    BlockMatrix matrix = random_matrix(80, components, random);
    BlockLU lu;
    for (int k = 0; k < 5; ++k) {
      expect_solved(matrix, lu, random);
      matrix.set_zero();
      fill(matrix, random);
    }
  }
}

TEST(block_lu, other_graph_of_equal_size_is_analysed_anew) {
  std::mt19937 random(13);
  BlockLU lu;
  for (int k = 0; k < 5; ++k) {
    expect_solved(random_matrix(50, 3, random), lu, random);
  }
}

TEST(block_lu, fill_in_stays_far_below_dense) {
  std::mt19937 random(14);
  const BlockMatrix matrix = random_matrix(400, 3, random);
  BlockLU lu;
  lu.analyse(matrix);
  EXPECT_GE(lu.factor_blocks(), matrix.nodes + 2 * matrix.edges.size());
  EXPECT_LT(lu.factor_blocks(), matrix.nodes * matrix.nodes / 8);
}

TEST(block_lu, solves_four_together) {
  std::mt19937 random(18);
  for (const int components : {2, 3}) {
    const BlockMatrix matrix = random_matrix(70, components, random);
    std::array<std::vector<double>, 4> b;
    for (auto& vector : b) vector = random_vector(unknowns(matrix), random);
    const auto right = together(matrix, b);
    auto x = right;
    BlockLU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    lu.solve_four(x);
    for (std::size_t l = 0; l < 4; ++l) expect_solution(matrix, b[l], lane(matrix, x, l));
    std::vector<Quad> r(x.size());
    matrix.residual_of_four(right, x, r);
    for (std::size_t l = 0; l < 4; ++l) {
      EXPECT_LE(as_eigen(lane(matrix, r, l)).norm(), 1e-12 * as_eigen(b[l]).norm());
    }
  }
}

TEST(block_lu, forgets_what_it_solved_before) {
  std::mt19937 random(19);
  const BlockMatrix first = random_matrix(90, 3, random);
  const BlockMatrix second = random_matrix(60, 2, random);
  const BlockMatrix third = random_matrix(90, 3, random);
  const auto b = random_vector(unknowns(third), random);
  BlockLU used;
  for (const auto* matrix : {&first, &second, &third, &first, &third}) {
    used.analyse(*matrix);
    ASSERT_TRUE(used.factorise(*matrix));
  }
  BlockLU fresh;
  fresh.analyse(third);
  ASSERT_TRUE(fresh.factorise(third));
  EXPECT_EQ(solve(used, third, b), solve(fresh, third, b));
}

TEST(block_lu, adds_to_the_diagonal) {
  std::mt19937 random(20);
  for (const int components : {2, 3}) {
    BlockMatrix matrix = random_matrix(30, components, random);
    const auto added = by_node(matrix, random_vector(unknowns(matrix), random));
    const auto b = random_vector(unknowns(matrix), random);
    BlockLU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix, added));
    const auto x = solve(lu, matrix, b);
    for (std::size_t q = 0; q < matrix.nodes; ++q) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(components); ++k) {
        matrix.block(q)[k].lane[k] += added[q].lane[k];
      }
    }
    expect_solution(matrix, b, x);
  }
}

TEST(block_lu, inverts_pivot_blocks_of_little_but_one_direction) {
  // As of a particle with one sliding contact, held by the grounding alone across it.
  for (const double ground : {1e-2, 1e-6, 1e-9}) {
    BlockMatrix matrix;
    matrix.reset(1, 3, {});
    const std::array<double, 3> row{0.6, 0.8, 0.3};
    const std::array<double, 3> column{0.5, -0.7, 0.2};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t r = 0; r < 3; ++r) matrix.block(0)[c].lane[r] = row[r] * column[c];
      matrix.block(0)[c].lane[c] += ground;
    }
    BlockLU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    const std::vector<double> b{1, 2, 3};
    const Eigen::VectorXd x = as_eigen(solve(lu, matrix, b));
    const Eigen::VectorXd exact = dense(matrix).fullPivLu().solve(as_eigen(b));
    EXPECT_LE((x - exact).norm(), 1e-13 / ground * exact.norm()) << ground;
  }
}

// As of particles that move in one direction without that a force changes: what holds them there is the grounding alone.
// The inverse of such a block would lose digits for all others too.
TEST(block_lu, solves_to_rounding_beside_blocks_that_are_nearly_singular) {
  std::mt19937 random(23);
  for (const int components : {2, 3}) {
    BlockMatrix matrix = random_matrix(80, components, random);
    const auto b = static_cast<std::size_t>(components);
    for (const std::size_t loose : {5U, 40U, 71U}) {
      Eigen::VectorXd direction = as_eigen(random_vector(b, random)).normalized();
      const auto let_go = [&](std::size_t block) {
        for (std::size_t r = 0; r < b; ++r) {
          double along = 0;
          for (std::size_t c = 0; c < b; ++c) {
            along += matrix.block(block)[c].lane[r] * direction[static_cast<Eigen::Index>(c)];
          }
          for (std::size_t c = 0; c < b; ++c) {
            matrix.block(block)[c].lane[r] -= along * direction[static_cast<Eigen::Index>(c)];
          }
        }
      };
      let_go(loose);
      for (std::size_t k = 0; k < b; ++k) matrix.block(loose)[k].lane[k] += 1e-12;
      for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
        const auto [p, q] = matrix.edges[e];
        if (static_cast<std::size_t>(p) == loose) let_go(matrix.lower(e));
        if (static_cast<std::size_t>(q) == loose) let_go(matrix.upper(e));
      }
    }
    const Eigen::VectorXd right = dense(matrix) * as_eigen(random_vector(unknowns(matrix), random));
    const std::vector<double> one(right.begin(), right.end());
    BlockLU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    auto four = together(matrix, {one, one, one, one});
    lu.solve_four(four);
    for (const auto& x : {solve(lu, matrix, one), lane(matrix, four, 2)}) {
      EXPECT_LE(defect(matrix, one, x), 1e-13);
    }
  }
}

TEST(block_lu, residual_is_that_of_the_dense_matrix) {
  std::mt19937 random(15);
  for (const int components : {2, 3}) {
    const BlockMatrix matrix = random_matrix(40, components, random);
    const auto x = random_vector(unknowns(matrix), random);
    const auto b = random_vector(unknowns(matrix), random);
    std::vector<Quad> r(matrix.nodes);
    matrix.residual(by_node(matrix, b), by_node(matrix, x), r);
    EXPECT_LE(
        (as_eigen(by_component(matrix, r)) - as_eigen(b) + dense(matrix) * as_eigen(x)).norm(),
        1e-12);
  }
}

TEST(block_lu, singular_pivot_block_is_reported) {
  std::mt19937 random(16);
  for (const int components : {2, 3}) {
    BlockMatrix matrix = random_matrix(1, components, random);
    const auto b = static_cast<std::size_t>(components);
    for (std::size_t row = 0; row < b; ++row) matrix.block(0)[1].lane[row] = 0;  // second column
    BlockLU lu;
    lu.analyse(matrix);
    EXPECT_FALSE(lu.factorise(matrix));
  }
}

std::vector<double> solve_by_gmres(BlockLU& lu, const BlockMatrix& matrix,
                                   const std::vector<double>& b) {
  std::vector<Quad> x(matrix.nodes);
  Gmres().solve(matrix, lu, 1e-13, by_node(matrix, b), x);
  return by_component(matrix, x);
}

TEST(gmres, solves_where_refinement_with_the_same_factors_diverges) {
  std::mt19937 random(17);
  for (const int components : {2, 3}) {
    const BlockMatrix factorised = random_matrix(200, components, random);
    BlockLU lu;
    lu.analyse(factorised);
    ASSERT_TRUE(lu.factorise(factorised));
    BlockMatrix matrix = factorised;  // three nodes three times as stiff
    for (const std::size_t q : {3U, 77U, 150U}) {
      for (int k = 0; k < components; ++k) {
        for (double& value : matrix.block(q)[k].lane) value *= 3;
      }
    }
    const auto b = random_vector(unknowns(matrix), random);
    auto refined = solve(lu, matrix, b);
    const double first = defect(matrix, b, refined);
    for (int k = 0; k < 10; ++k) {
      const Eigen::VectorXd rest = as_eigen(b) - dense(matrix) * as_eigen(refined);
      const auto more = solve(lu, matrix, {rest.begin(), rest.end()});
      for (std::size_t l = 0; l < more.size(); ++l) refined[l] += more[l];
    }
    ASSERT_GT(defect(matrix, b, refined), first);
    expect_solution(matrix, b, solve_by_gmres(lu, matrix, b));
  }
}

// A node that nothing holds but what the factors add, to it and to the others.
BlockMatrix with_loose_node(int components, double to_others, std::mt19937& random, BlockLU& lu) {
  BlockMatrix matrix = random_matrix(60, components, random);
  const auto b = static_cast<std::size_t>(components);
  std::fill_n(matrix.block(7), b, Quad{});
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    if (matrix.edges[e].first != 7 && matrix.edges[e].second != 7) continue;
    std::fill_n(matrix.block(matrix.upper(e)), b, Quad{});
    std::fill_n(matrix.block(matrix.lower(e)), b, Quad{});
  }
  std::vector<Quad> ground(matrix.nodes);
  for (std::size_t q = 0; q < ground.size(); ++q) {
    for (std::size_t k = 0; k < b; ++k) ground[q].lane[k] = q == 7 ? 0.5 : to_others;
  }
  lu.analyse(matrix);
  EXPECT_TRUE(lu.factorise(matrix, ground));
  return matrix;
}

TEST(gmres, solves_a_singular_matrix_for_what_is_in_its_range) {
  std::mt19937 random(18);
  for (const int components : {2, 3}) {
    BlockLU lu;
    const BlockMatrix matrix = with_loose_node(components, 0.5, random, lu);
    auto b = random_vector(unknowns(matrix), random);
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (k % matrix.nodes == 7) b[k] = 0;
    }
    EXPECT_LE(defect(matrix, b, solve_by_gmres(lu, matrix, b)), 1e-12);
  }
}

TEST(gmres, leaves_of_the_rest_what_is_not_in_the_range) {
  std::mt19937 random(19);
  BlockLU lu;
  const BlockMatrix matrix = with_loose_node(3, 0, random, lu);
  auto b = random_vector(unknowns(matrix), random);
  b[7] = 0.25;
  b[7 + matrix.nodes] = b[7 + 2 * matrix.nodes] = 0;
  const Eigen::VectorXd rest =
      as_eigen(b) - dense(matrix) * as_eigen(solve_by_gmres(lu, matrix, b));
  EXPECT_NEAR(rest.norm(), 0.25, 1e-12);
}

}  // namespace
}  // namespace grainlaw
