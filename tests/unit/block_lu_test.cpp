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
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace grainlaw::core {
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
template <std::size_t width>
void fill(BlockMatrix<width>& matrix, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto b = static_cast<std::size_t>(matrix.components);
  const double outweighing = std::max(6, 2 * matrix.components);
  for (auto& column : matrix.blocks) {
    for (std::size_t row = 0; row < b; ++row) column.lane[row] = uniform(random);
  }
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) matrix.block(q)[k].lane[k] += outweighing;
  }
}

template <std::size_t width>
Eigen::MatrixXd dense(const BlockMatrix<width>& matrix) {
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

// One column per node.
template <std::size_t width>
std::vector<BlockColumn<width>> by_node(const BlockMatrix<width>& matrix,
                                        const std::vector<double>& values) {
  std::vector<BlockColumn<width>> result(matrix.nodes);
  for (std::size_t k = 0; k < values.size(); ++k) {
    result[k % matrix.nodes].lane[k / matrix.nodes] = values[k];
  }
  return result;
}

template <std::size_t width>
std::vector<double> by_component(const BlockMatrix<width>& matrix,
                                 const std::vector<BlockColumn<width>>& values) {
  std::vector<double> result(matrix.nodes * static_cast<std::size_t>(matrix.components));
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = values[k % matrix.nodes].lane[k / matrix.nodes];
  }
  return result;
}

template <std::size_t width>
std::vector<double> solve(BlockLU<width>& lu, const BlockMatrix<width>& matrix,
                          const std::vector<double>& b) {
  auto x = by_node(matrix, b);
  lu.solve(x);
  return by_component(matrix, x);
}

// Vector l in lane l: one for each node and component.
template <std::size_t width>
std::vector<Together<width>> together(const BlockMatrix<width>& matrix,
                                      const std::array<std::vector<double>, width>& vectors) {
  const auto b = static_cast<std::size_t>(matrix.components);
  std::vector<Together<width>> result(matrix.nodes * b);
  for (std::size_t l = 0; l < width; ++l) {
    for (std::size_t k = 0; k < result.size(); ++k) {
      result[k % matrix.nodes * b + k / matrix.nodes].lane[l] = vectors[l][k];
    }
  }
  return result;
}

template <std::size_t width>
std::vector<double> lane(const BlockMatrix<width>& matrix,
                         const std::vector<Together<width>>& vectors, std::size_t l) {
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
template <std::size_t width>
double defect(const BlockMatrix<width>& matrix, const std::vector<double>& b,
              const std::vector<double>& x) {
  return (as_eigen(b) - dense(matrix) * as_eigen(x)).cwiseAbs().maxCoeff() /
         as_eigen(b).cwiseAbs().maxCoeff();
}

template <std::size_t width>
void expect_solution(const BlockMatrix<width>& matrix, const std::vector<double>& b,
                     const std::vector<double>& x) {
  const Eigen::VectorXd expected = dense(matrix).partialPivLu().solve(as_eigen(b));
  EXPECT_LE((as_eigen(x) - expected).norm(), 1e-10 * expected.norm());
}

template <std::size_t width>
BlockMatrix<width> random_matrix(std::size_t nodes, int components, std::mt19937& random) {
  BlockMatrix<width> matrix;
  matrix.reset(nodes, components, near_pairs(nodes, random));
  fill(matrix, random);
  return matrix;
}

template <std::size_t width>
std::size_t unknowns(const BlockMatrix<width>& matrix) {
  return matrix.nodes * static_cast<std::size_t>(matrix.components);
}

template <std::size_t width>
void expect_solved(const BlockMatrix<width>& matrix, BlockLU<width>& lu, std::mt19937& random) {
  lu.analyse(matrix);
  ASSERT_TRUE(lu.factorise(matrix));
  const auto b = random_vector(unknowns(matrix), random);
  expect_solution(matrix, b, solve(lu, matrix, b));
}

// Blocks of 2 and 3 fill columns of four, blocks of 6 columns of eight.
struct ColumnsOfFour {
  static constexpr std::size_t width = 4;
  static constexpr std::array components{2, 3};
};
struct ColumnsOfEight {
  static constexpr std::size_t width = 8;
  static constexpr std::array components{6};
};

template <class Columns>
struct block_lu : testing::Test, Columns {
  using Matrix = BlockMatrix<Columns::width>;
  using LU = BlockLU<Columns::width>;
  static constexpr int least = Columns::components.front();
  static constexpr int most = Columns::components.back();
};
template <class Columns>
struct gmres : block_lu<Columns> {};
using EveryColumns = testing::Types<ColumnsOfFour, ColumnsOfEight>;
TYPED_TEST_SUITE(block_lu, EveryColumns);
TYPED_TEST_SUITE(gmres, EveryColumns);

TYPED_TEST(block_lu, solves_as_a_dense_factorisation_does) {
  std::mt19937 random(11);
  typename TestFixture::LU lu;  // of one matrix after the other
  for (const int components : TestFixture::components) {
    for (const std::size_t nodes : {1U, 2U, 10U, 60U, 200U}) {
      expect_solved(random_matrix<TestFixture::width>(nodes, components, random), lu, random);
    }
  }
}

// Groups of nodes that all touch each other, one after the other; `shared` of each are the next one's too.
template <std::size_t width>
BlockMatrix<width> chained_groups(std::size_t groups, std::size_t size, std::size_t shared,
                                  int components, std::mt19937& random) {
  std::set<Edge> edges;
  const std::size_t step = size - shared;
  for (std::size_t g = 0; g < groups; ++g) {
    for (std::size_t p = g * step; p < g * step + size; ++p) {
      for (std::size_t q = p + 1; q < g * step + size; ++q) {
        edges.emplace(static_cast<std::int32_t>(p), static_cast<std::int32_t>(q));
      }
    }
  }
  BlockMatrix<width> matrix;
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

// 8 nodes of 3 unknowns, 12 of 2 and 4 of 6 fill a block of pivots.
TYPED_TEST(block_lu, eliminates_fronts_of_any_size) {
  std::mt19937 random(21);
  typename TestFixture::LU lu;  // of one matrix after the other
  for (const int components : TestFixture::components) {
    for (const std::size_t size : {3U, 4U, 5U, 7U, 8U, 9U, 12U, 13U, 17U, 40U}) {
      expect_solved(chained_groups<TestFixture::width>(1, size, 0, components, random), lu, random);
      for (const std::size_t shared : {std::size_t{1}, size / 2}) {
        expect_solved(chained_groups<TestFixture::width>(4, size, shared, components, random), lu,
                      random);
      }
    }
  }
}

TYPED_TEST(block_lu, solves_parts_that_do_not_touch) {
  std::mt19937 random(22);
  typename TestFixture::LU lu;
  for (const int components : TestFixture::components) {
    expect_solved(chained_groups<TestFixture::width>(5, 6, 0, components, random), lu, random);
    expect_solved(chained_groups<TestFixture::width>(30, 1, 0, components, random), lu, random);
  }
}

TYPED_TEST(block_lu, analysis_serves_other_values_on_the_same_graph) {
  std::mt19937 random(12);
  for (const int components : TestFixture::components) {
    auto matrix = random_matrix<TestFixture::width>(80, components, random);
    typename TestFixture::LU lu;
    for (int k = 0; k < 5; ++k) {
      expect_solved(matrix, lu, random);
      matrix.set_zero();
      fill(matrix, random);
    }
  }
}

TYPED_TEST(block_lu, other_graph_of_equal_size_is_analysed_anew) {
  std::mt19937 random(13);
  typename TestFixture::LU lu;
  for (int k = 0; k < 5; ++k) {
    expect_solved(random_matrix<TestFixture::width>(50, TestFixture::most, random), lu, random);
  }
}

TYPED_TEST(block_lu, fill_in_stays_far_below_dense) {
  std::mt19937 random(14);
  const auto matrix = random_matrix<TestFixture::width>(400, TestFixture::most, random);
  typename TestFixture::LU lu;
  lu.analyse(matrix);
  EXPECT_GE(lu.factor_blocks(), matrix.nodes + 2 * matrix.edges.size());
  EXPECT_LT(lu.factor_blocks(), matrix.nodes * matrix.nodes / 8);
}

TYPED_TEST(block_lu, solves_several_together) {
  std::mt19937 random(18);
  for (const int components : TestFixture::components) {
    const auto matrix = random_matrix<TestFixture::width>(70, components, random);
    std::array<std::vector<double>, TestFixture::width> b;
    for (auto& vector : b) vector = random_vector(unknowns(matrix), random);
    const auto right = together(matrix, b);
    auto x = right;
    typename TestFixture::LU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    lu.solve_together(x);
    for (std::size_t l = 0; l < TestFixture::width; ++l)
      expect_solution(matrix, b[l], lane(matrix, x, l));
    auto r = right;
    matrix.residual_together(right, x, r);
    for (std::size_t l = 0; l < TestFixture::width; ++l) {
      EXPECT_LE(as_eigen(lane(matrix, r, l)).norm(), 1e-12 * as_eigen(b[l]).norm());
    }
  }
}

TYPED_TEST(block_lu, forgets_what_it_solved_before) {
  std::mt19937 random(19);
  const auto first = random_matrix<TestFixture::width>(90, TestFixture::most, random);
  const auto second = random_matrix<TestFixture::width>(60, TestFixture::least, random);
  const auto third = random_matrix<TestFixture::width>(90, TestFixture::most, random);
  const auto b = random_vector(unknowns(third), random);
  typename TestFixture::LU used;
  for (const auto* matrix : {&first, &second, &third, &first, &third}) {
    used.analyse(*matrix);
    ASSERT_TRUE(used.factorise(*matrix));
  }
  typename TestFixture::LU fresh;
  fresh.analyse(third);
  ASSERT_TRUE(fresh.factorise(third));
  EXPECT_EQ(solve(used, third, b), solve(fresh, third, b));
}

TYPED_TEST(block_lu, adds_to_the_diagonal) {
  std::mt19937 random(20);
  for (const int components : TestFixture::components) {
    auto matrix = random_matrix<TestFixture::width>(30, components, random);
    const auto added = by_node(matrix, random_vector(unknowns(matrix), random));
    const auto b = random_vector(unknowns(matrix), random);
    typename TestFixture::LU lu;
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

TYPED_TEST(block_lu, inverts_pivot_blocks_of_little_but_one_direction) {
  // As of a particle with one sliding contact, held by the grounding alone across it.
  for (const double ground : {1e-2, 1e-6, 1e-9}) {
    typename TestFixture::Matrix matrix;
    matrix.reset(1, TestFixture::most, {});
    constexpr std::size_t size = TestFixture::most;
    constexpr std::array row{0.6, 0.8, 0.3, -0.5, 0.4, 0.7};
    constexpr std::array column{0.5, -0.7, 0.2, 0.3, -0.4, 0.6};
    for (std::size_t c = 0; c < size; ++c) {
      for (std::size_t r = 0; r < size; ++r) matrix.block(0)[c].lane[r] = row[r] * column[c];
      matrix.block(0)[c].lane[c] += ground;
    }
    typename TestFixture::LU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    std::vector<double> b(size);
    std::iota(b.begin(), b.end(), 1.0);
    const Eigen::VectorXd x = as_eigen(solve(lu, matrix, b));
    const Eigen::VectorXd exact = dense(matrix).fullPivLu().solve(as_eigen(b));
    EXPECT_LE((x - exact).norm(), 1e-13 / ground * exact.norm()) << ground;
  }
}

// As of particles that move in one direction without that a force changes: what holds them there is the grounding alone.
// The inverse of such a block would lose digits for all others too.
TYPED_TEST(block_lu, solves_to_rounding_beside_blocks_that_are_nearly_singular) {
  std::mt19937 random(23);
  for (const int components : TestFixture::components) {
    auto matrix = random_matrix<TestFixture::width>(80, components, random);
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
    typename TestFixture::LU lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    std::array<std::vector<double>, TestFixture::width> same;
    same.fill(one);
    auto several = together(matrix, same);
    lu.solve_together(several);
    for (const auto& x : {solve(lu, matrix, one), lane(matrix, several, 2)}) {
      EXPECT_LE(defect(matrix, one, x), 1e-13);
    }
  }
}

TYPED_TEST(block_lu, residual_is_that_of_the_dense_matrix) {
  std::mt19937 random(15);
  for (const int components : TestFixture::components) {
    const auto matrix = random_matrix<TestFixture::width>(40, components, random);
    const auto x = random_vector(unknowns(matrix), random);
    const auto b = random_vector(unknowns(matrix), random);
    std::vector<BlockColumn<TestFixture::width>> r(matrix.nodes);
    matrix.residual(by_node(matrix, b), by_node(matrix, x), r);
    EXPECT_LE(
        (as_eigen(by_component(matrix, r)) - as_eigen(b) + dense(matrix) * as_eigen(x)).norm(),
        1e-12);
  }
}

TYPED_TEST(block_lu, singular_pivot_block_is_reported) {
  std::mt19937 random(16);
  for (const int components : TestFixture::components) {
    auto matrix = random_matrix<TestFixture::width>(1, components, random);
    const auto b = static_cast<std::size_t>(components);
    for (std::size_t row = 0; row < b; ++row) matrix.block(0)[1].lane[row] = 0;  // second column
    typename TestFixture::LU lu;
    lu.analyse(matrix);
    EXPECT_FALSE(lu.factorise(matrix));
  }
}

template <std::size_t width>
std::vector<double> solve_by_gmres(BlockLU<width>& lu, const BlockMatrix<width>& matrix,
                                   const std::vector<double>& b) {
  std::vector<BlockColumn<width>> x(matrix.nodes);
  Gmres<width>().solve(matrix, lu, 1e-13, by_node(matrix, b), x);
  return by_component(matrix, x);
}

TYPED_TEST(gmres, solves_where_refinement_with_the_same_factors_diverges) {
  std::mt19937 random(17);
  for (const int components : TestFixture::components) {
    const auto factorised = random_matrix<TestFixture::width>(200, components, random);
    typename TestFixture::LU lu;
    lu.analyse(factorised);
    ASSERT_TRUE(lu.factorise(factorised));
    auto matrix = factorised;  // three nodes three times as stiff
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
template <std::size_t width>
BlockMatrix<width> with_loose_node(int components, double to_others, std::mt19937& random,
                                   BlockLU<width>& lu) {
  BlockMatrix<width> matrix = random_matrix<width>(60, components, random);
  const auto b = static_cast<std::size_t>(components);
  std::fill_n(matrix.block(7), b, BlockColumn<width>{});
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    if (matrix.edges[e].first != 7 && matrix.edges[e].second != 7) continue;
    std::fill_n(matrix.block(matrix.upper(e)), b, BlockColumn<width>{});
    std::fill_n(matrix.block(matrix.lower(e)), b, BlockColumn<width>{});
  }
  std::vector<BlockColumn<width>> ground(matrix.nodes);
  for (std::size_t q = 0; q < ground.size(); ++q) {
    for (std::size_t k = 0; k < b; ++k) ground[q].lane[k] = q == 7 ? 0.5 : to_others;
  }
  lu.analyse(matrix);
  EXPECT_TRUE(lu.factorise(matrix, ground));
  return matrix;
}

TYPED_TEST(gmres, solves_a_singular_matrix_for_what_is_in_its_range) {
  std::mt19937 random(18);
  for (const int components : TestFixture::components) {
    typename TestFixture::LU lu;
    const auto matrix = with_loose_node(components, 0.5, random, lu);
    auto b = random_vector(unknowns(matrix), random);
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (k % matrix.nodes == 7) b[k] = 0;
    }
    EXPECT_LE(defect(matrix, b, solve_by_gmres(lu, matrix, b)), 1e-12);
  }
}

TYPED_TEST(gmres, leaves_of_the_rest_what_is_not_in_the_range) {
  std::mt19937 random(19);
  typename TestFixture::LU lu;
  const auto matrix = with_loose_node(TestFixture::most, 0, random, lu);
  auto b = random_vector(unknowns(matrix), random);
  b[7] = 0.25;
  for (std::size_t k = 7 + matrix.nodes; k < b.size(); k += matrix.nodes) b[k] = 0;
  const Eigen::VectorXd rest =
      as_eigen(b) - dense(matrix) * as_eigen(solve_by_gmres(lu, matrix, b));
  EXPECT_NEAR(rest.norm(), 0.25, 1e-12);
}

}  // namespace
}  // namespace grainlaw::core
