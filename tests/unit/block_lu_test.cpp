// The block factorisation against a dense one, on random matrices over random planar graphs.
#include "equilibrium/block_matrix.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
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
  const auto s = static_cast<std::size_t>(matrix.stride);
  for (auto* values : {&matrix.diagonal, &matrix.upper, &matrix.lower}) {
    for (std::size_t k = 0; k < values->size(); ++k) {
      if (k % s < b) (*values)[k] = uniform(random);  // the padding stays zero
    }
  }
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) matrix.diagonal[q * matrix.block_size() + k * s + k] += 6;
  }
}

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const auto nodes = static_cast<Eigen::Index>(matrix.nodes);
  const auto size = static_cast<std::ptrdiff_t>(matrix.block_size());
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(matrix.components * nodes, matrix.components * nodes);
  const auto add = [&](const std::vector<double>& blocks, std::ptrdiff_t place, Eigen::Index row,
                       Eigen::Index column) {
    for (int c = 0; c < matrix.components; ++c) {
      for (int r = 0; r < matrix.components; ++r) {
        result(r * nodes + row, c * nodes + column) =
            blocks[static_cast<std::size_t>(place * size + c * matrix.stride + r)];
      }
    }
  };
  for (Eigen::Index q = 0; q < nodes; ++q) add(matrix.diagonal, q, q, q);
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    const auto [p, q] = matrix.edges[e];
    add(matrix.upper, static_cast<std::ptrdiff_t>(e), p, q);
    add(matrix.lower, static_cast<std::ptrdiff_t>(e), q, p);
  }
  return result;
}

std::vector<double> random_vector(std::size_t size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> values(size);
  for (double& value : values) value = uniform(random);
  return values;
}

Eigen::VectorXd as_eigen(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
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

TEST(block_lu, solves_as_a_dense_factorisation_does) {
  std::mt19937 random(11);
  BlockLU lu;  // of one matrix after the other
  for (const int components : {2, 3}) {
    for (const std::size_t nodes : {1U, 2U, 10U, 60U, 200U}) {
      const BlockMatrix matrix = random_matrix(nodes, components, random);
      lu.analyse(matrix);
      ASSERT_TRUE(lu.factorise(matrix));
      const auto b = random_vector(unknowns(matrix), random);
      std::vector<double> x(b.size());
      lu.solve(b, x);
      expect_solution(matrix, b, x);
      std::vector<double> in_place = b;
      lu.solve(in_place, in_place);
      EXPECT_EQ(in_place, x);
    }
  }
}

TEST(block_lu, analysis_serves_other_values_on_the_same_graph) {
  std::mt19937 random(12);
  for (const int components : {2, 3}) {
    BlockMatrix matrix = random_matrix(80, components, random);
    BlockLU lu;
    for (int k = 0; k < 5; ++k) {
      lu.analyse(matrix);
      ASSERT_TRUE(lu.factorise(matrix));
      const auto b = random_vector(unknowns(matrix), random);
      std::vector<double> x(b.size());
      lu.solve(b, x);
      expect_solution(matrix, b, x);
      matrix.set_zero();
      fill(matrix, random);
    }
  }
}

TEST(block_lu, other_graph_of_equal_size_is_analysed_anew) {
  std::mt19937 random(13);
  BlockLU lu;
  for (int k = 0; k < 5; ++k) {
    const BlockMatrix matrix = random_matrix(50, 3, random);
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    const auto b = random_vector(unknowns(matrix), random);
    std::vector<double> x(b.size());
    lu.solve(b, x);
    expect_solution(matrix, b, x);
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

TEST(block_lu, multiplies_as_the_dense_matrix_does) {
  std::mt19937 random(15);
  for (const int components : {2, 3}) {
    const BlockMatrix matrix = random_matrix(40, components, random);
    const auto x = random_vector(unknowns(matrix), random);
    std::vector<double> y(x.size(), 7);
    matrix.multiply(x, y);
    EXPECT_LE((as_eigen(y) - dense(matrix) * as_eigen(x)).norm(), 1e-12);
  }
}

TEST(block_lu, singular_pivot_block_is_reported) {
  std::mt19937 random(16);
  for (const int components : {2, 3}) {
    BlockMatrix matrix = random_matrix(1, components, random);
    const auto b = static_cast<std::size_t>(components);
    const auto s = static_cast<std::size_t>(matrix.stride);
    for (std::size_t row = 0; row < b; ++row) matrix.diagonal[s + row] = 0;  // second column
    BlockLU lu;
    lu.analyse(matrix);
    EXPECT_FALSE(lu.factorise(matrix));
    const auto right = random_vector(unknowns(matrix), random);
    std::vector<double> x(right.size());
    EXPECT_FALSE(solve_with_pivoting(matrix, right, x));
  }
}

TEST(block_lu, pivoting_solves_what_has_no_pivots_on_the_diagonal) {
  // Two nodes that hold only each other: the diagonal blocks are zero, the matrix is regular.
  std::mt19937 random(17);
  for (const int components : {2, 3}) {
    BlockMatrix matrix;
    const std::vector<Edge> edges{{0, 1}};
    matrix.reset(2, components, edges);
    fill(matrix, random);
    std::fill(matrix.diagonal.begin(), matrix.diagonal.end(), 0.0);
    BlockLU lu;
    lu.analyse(matrix);
    EXPECT_FALSE(lu.factorise(matrix));
    const auto b = random_vector(unknowns(matrix), random);
    std::vector<double> x(b.size());
    ASSERT_TRUE(solve_with_pivoting(matrix, b, x));
    expect_solution(matrix, b, x);
  }
}

}  // namespace
}  // namespace grainlaw
