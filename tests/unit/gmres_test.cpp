// GMRES where the factors are those of another matrix, or the matrix is singular.
#include "linear/gmres.hpp"
#include "block_matrices.hpp"

namespace grainlaw::core::test {
namespace {

template <class Columns>
struct gmres : OfColumns<Columns> {};
TYPED_TEST_SUITE(gmres, EveryColumns);

template <std::size_t width>
std::vector<double> solve_by_gmres(BlockLU<width>& lu, const BlockMatrix<width>& matrix,
                                   const std::vector<double>& b) {
  std::vector<BlockColumn<width>> x(matrix.nodes);
  Gmres<width>().solve(matrix, lu, 1e-13, by_node(matrix, b), x);
  return by_component(matrix, x);
}

TYPED_TEST(gmres, solves_where_refinement_with_the_same_factors_diverges) {
  std::mt19937 random(17);
  for (const auto components : TestFixture::components) {
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
BlockMatrix<width> with_loose_node(BlockSize<width> components, double to_others,
                                   std::mt19937& random, BlockLU<width>& lu) {
  BlockMatrix<width> matrix = random_matrix<width>(60, components, random);
  const auto b = static_cast<std::size_t>(components);
  std::fill_n(matrix.block(7), b, BlockColumn<width>{});
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    if (matrix.edges[e].first != 7 && matrix.edges[e].second != 7) continue;
    std::fill_n(matrix.block(matrix.upper(e)), b, BlockColumn<width>{});
    std::fill_n(matrix.block(matrix.lower(e)), b, BlockColumn<width>{});
  }
  std::vector<BlockColumn<width>> regularisation(matrix.nodes);
  for (std::size_t q = 0; q < regularisation.size(); ++q) {
    for (std::size_t k = 0; k < b; ++k) regularisation[q].lane[k] = q == 7 ? 0.5 : to_others;
  }
  lu.analyse(matrix);
  EXPECT_TRUE(lu.factorise(matrix, regularisation));
  return matrix;
}

TYPED_TEST(gmres, solves_a_singular_matrix_for_what_is_in_its_range) {
  std::mt19937 random(18);
  for (const auto components : TestFixture::components) {
    typename TestFixture::LU lu;
    const auto matrix = with_loose_node<TestFixture::width>(components, 0.5, random, lu);
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
  const auto matrix = with_loose_node<TestFixture::width>(TestFixture::most, 0, random, lu);
  auto b = random_vector(unknowns(matrix), random);
  b[7] = 0.25;
  for (std::size_t k = 7 + matrix.nodes; k < b.size(); k += matrix.nodes) b[k] = 0;
  const Eigen::VectorXd rest =
      as_eigen(b) - dense(matrix) * as_eigen(solve_by_gmres(lu, matrix, b));
  EXPECT_NEAR(rest.norm(), 0.25, 1e-12);
}

}  // namespace
}  // namespace grainlaw::core::test
