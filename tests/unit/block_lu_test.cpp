// The block factorisation against a dense one.
#include "block_matrices.hpp"

#include <numeric>
#include <set>

namespace grainlaw::core::test {
namespace {

template <class Columns>
struct block_lu : OfColumns<Columns> {};
TYPED_TEST_SUITE(block_lu, EveryColumns);

TYPED_TEST(block_lu, solves_as_a_dense_factorisation_does) {
  std::mt19937 random(11);
  typename TestFixture::LU lu;  // of one matrix after the other
  for (const auto components : TestFixture::components) {
    for (const std::size_t nodes : {1U, 2U, 10U, 60U, 200U}) {
      expect_solved(random_matrix<TestFixture::width>(nodes, components, random), lu, random);
    }
  }
}

// Groups of nodes that all touch each other, one after the other; `shared` of each are the next one's too.
template <std::size_t width>
BlockMatrix<width> chained_groups(std::size_t groups, std::size_t size, std::size_t shared,
                                  BlockSize<width> components, std::mt19937& random) {
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
  for (const auto components : TestFixture::components) {
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
  for (const auto components : TestFixture::components) {
    expect_solved(chained_groups<TestFixture::width>(5, 6, 0, components, random), lu, random);
    expect_solved(chained_groups<TestFixture::width>(30, 1, 0, components, random), lu, random);
  }
}

TYPED_TEST(block_lu, analysis_serves_other_values_on_the_same_graph) {
  std::mt19937 random(12);
  for (const auto components : TestFixture::components) {
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
  for (const auto components : TestFixture::components) {
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
  for (const auto components : TestFixture::components) {
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
  // A particle with one sliding contact has such a block: across it there is the regularisation alone.
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

// Particles that move in one direction without any change of force have such blocks: in that
// direction there is the regularisation alone. The inverse of one would lose digits for all others too.
TYPED_TEST(block_lu, solves_to_rounding_beside_blocks_that_are_nearly_singular) {
  std::mt19937 random(23);
  for (const auto components : TestFixture::components) {
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
  for (const auto components : TestFixture::components) {
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
  for (const auto components : TestFixture::components) {
    auto matrix = random_matrix<TestFixture::width>(1, components, random);
    const auto b = static_cast<std::size_t>(components);
    for (std::size_t row = 0; row < b; ++row) matrix.block(0)[1].lane[row] = 0;  // second column
    typename TestFixture::LU lu;
    lu.analyse(matrix);
    EXPECT_FALSE(lu.factorise(matrix));
  }
}

}  // namespace
}  // namespace grainlaw::core::test
