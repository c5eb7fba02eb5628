// Krylov methods with DILU factors against a dense factorisation, and where they have to give up.
#include "block_matrices.hpp"
#include "linear/iterative.hpp"

#include <limits>

namespace grainlaw::core::test {
namespace {

constexpr std::size_t width = Dilu::width;
using One = BlockColumn<width>;
using Several = Together<width>;

enum class Method { bicgstab, idr };
constexpr std::array methods{Method::bicgstab, Method::idr};

// Residual that the precision of a method can reach.
double least_residual(Method method) { return method == Method::idr ? 1e-11 : 1e-5; }

LaneScalars tolerance(double value) {
  LaneScalars result;
  std::fill_n(result.lane, width, value);
  return result;
}

Krylov<BlockColumn<width, float>> in_single(One /*entry*/) { return {}; }
Krylov<Together<width, float>> in_single(Several /*entry*/) { return {}; }

template <class Entry>
int run(Method method, Dilu& dilu, const std::vector<Entry>& b, std::vector<Entry>& x,
        double relative, int most) {
  x.resize(b.size());
  if (method == Method::idr) return Krylov<Entry>{}.idr(dilu, b, x, tolerance(relative), most);
  return in_single(Entry{}).bicgstab(dilu, b, x, tolerance(relative), most);
}

// The components of a node's rotation have other units than those of its place.
BlockMatrix<width> matrix_of_units(std::size_t nodes, std::mt19937& random) {
  auto matrix = random_matrix<width>(nodes, blocks_of_6, random);
  constexpr double unit = 1e-3;
  for (std::size_t k = 0; k < matrix.blocks.size(); ++k) {
    for (std::size_t r = 3; r < 6; ++r) matrix.blocks[k].lane[r] *= unit;
    if (k % 6 >= 3) {
      for (double& value : matrix.blocks[k].lane) value *= unit;
    }
  }
  return matrix;
}

std::vector<One> regularisation_of(const BlockMatrix<width>& matrix, double value) {
  std::vector<One> regularisation(matrix.nodes);
  for (auto& of_node : regularisation) std::fill_n(of_node.lane, Dilu::size, value);
  return regularisation;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  return (as_eigen(a) - as_eigen(b)).norm() / as_eigen(b).norm();
}

TEST(krylov, solves_as_a_factorisation_does) {
  std::mt19937 random(31);
  Dilu dilu;  // of one matrix after the other
  for (const std::size_t nodes : {1U, 2U, 10U, 60U, 200U}) {
    const auto matrix = matrix_of_units(nodes, random);
    BlockLU<width> lu;
    lu.analyse(matrix);
    ASSERT_TRUE(lu.factorise(matrix));
    dilu.factorise(matrix, regularisation_of(matrix, 1e-12));
    const auto b = random_vector(unknowns(matrix), random);
    for (const auto method : methods) {
      std::vector<One> x;
      const double least = least_residual(method);
      EXPECT_LE(run(method, dilu, by_node(matrix, b), x, least, 200), 200);
      EXPECT_LE(difference(by_component(matrix, x), solve(lu, matrix, b)), 1e3 * least) << nodes;
    }
  }
}

TEST(krylov, solves_several_together_as_one_by_one) {
  std::mt19937 random(32);
  const auto matrix = matrix_of_units(100, random);
  BlockLU<width> lu;
  lu.analyse(matrix);
  ASSERT_TRUE(lu.factorise(matrix));
  Dilu dilu;
  dilu.factorise(matrix, regularisation_of(matrix, 1e-12));
  std::array<std::vector<double>, width> right;
  for (auto& b : right) b = random_vector(unknowns(matrix), random);
  std::fill(right[6].begin(), right[6].end(), 0.0);
  for (const auto method : methods) {
    std::vector<Several> x;
    const double least = least_residual(method);
    run(method, dilu, together(matrix, right), x, least, 200);
    for (std::size_t l = 0; l < width; ++l) {
      if (l == 6) {
        for (const double value : lane(matrix, x, l)) EXPECT_EQ(value, 0);
      } else {
        EXPECT_LE(difference(lane(matrix, x, l), solve(lu, matrix, right[l])), 1e3 * least) << l;
      }
    }
  }
}

TEST(krylov, a_block_triangular_matrix_takes_next_to_no_products) {
  std::mt19937 random(33);
  auto matrix = matrix_of_units(100, random);
  LevelOrder order;
  order.find(matrix.nodes, matrix.edges);
  const auto place = [&](std::int32_t q) { return order.place()[static_cast<std::size_t>(q)]; };
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    const auto [p, q] = matrix.edges[e];
    const std::size_t below = place(p) < place(q) ? matrix.lower(e) : matrix.upper(e);
    std::fill_n(matrix.block(below), Dilu::size, One{});
  }
  Dilu dilu;
  dilu.factorise(matrix, regularisation_of(matrix, 1e-15));
  const auto b = random_vector(unknowns(matrix), random);
  for (const auto method : methods) {
    std::vector<One> x;
    const double least = 1e3 * least_residual(method);
    EXPECT_LE(run(method, dilu, by_node(matrix, b), x, least, 200), 2);
    EXPECT_LE(defect(matrix, b, by_component(matrix, x)), 10 * least);
  }
}

TEST(krylov, fewer_products_for_a_looser_tolerance) {
  std::mt19937 random(34);
  const auto matrix = matrix_of_units(200, random);
  Dilu dilu;
  dilu.factorise(matrix, regularisation_of(matrix, 1e-12));
  const auto b = by_node(matrix, random_vector(unknowns(matrix), random));
  for (const auto method : methods) {
    std::vector<One> x;
    const double least = least_residual(method);
    EXPECT_LT(2 * run(method, dilu, b, x, std::pow(least, 0.2), 200),
              run(method, dilu, b, x, least, 200));
  }
}

TEST(krylov, a_node_that_nothing_holds_stays_where_nothing_moves_it) {
  std::mt19937 random(35);
  auto matrix = matrix_of_units(60, random);
  std::fill_n(matrix.block(7), Dilu::size, One{});
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    if (matrix.edges[e].first != 7 && matrix.edges[e].second != 7) continue;
    std::fill_n(matrix.block(matrix.upper(e)), Dilu::size, One{});
    std::fill_n(matrix.block(matrix.lower(e)), Dilu::size, One{});
  }
  Dilu dilu;
  dilu.factorise(matrix, regularisation_of(matrix, 1e-9));
  auto b = random_vector(unknowns(matrix), random);
  for (std::size_t k = 7; k < b.size(); k += matrix.nodes) b[k] = 0;
  for (const auto method : methods) {
    std::vector<One> x;
    const double least = least_residual(method);
    run(method, dilu, by_node(matrix, b), x, 0.1 * least, 200);
    EXPECT_LE(defect(matrix, b, by_component(matrix, x)), 1e3 * least);
    for (const double value : x[7].lane) EXPECT_EQ(value, 0);
  }
}

TEST(krylov, gives_up_after_the_products_it_may_spend) {
  std::mt19937 random(36);
  auto matrix = matrix_of_units(100, random);
  std::swap(matrix.blocks[0], matrix.blocks[6 * 50]);
  Dilu dilu;
  dilu.factorise(matrix, regularisation_of(matrix, 1e-12));
  const auto b = random_vector(unknowns(matrix), random);
  for (const auto method : methods) {
    std::vector<One> x;
    EXPECT_LE(run(method, dilu, by_node(matrix, b), x, 0, 6), 10);  // a space is gone through
    EXPECT_GT(defect(matrix, b, by_component(matrix, x)), 1e-12);
  }
}

TEST(krylov, ends_where_numbers_are_none) {
  std::mt19937 random(37);
  auto matrix = matrix_of_units(20, random);
  Dilu dilu;
  dilu.factorise(matrix, regularisation_of(matrix, 1e-12));
  auto b = random_vector(unknowns(matrix), random);
  b[3] = std::numeric_limits<double>::quiet_NaN();
  for (const auto method : methods) {
    std::vector<One> x;
    EXPECT_EQ(run(method, dilu, by_node(matrix, b), x, 1e-8, 200), 0);
  }
}

// Whatever the units of the right-hand side, whose squares single precision would not hold.
TEST(krylov, cycles_in_single_precision_reach_residuals_of_double_precision) {
  std::mt19937 random(38);
  const auto matrix = matrix_of_units(200, random);
  BlockLU<width> lu;
  lu.analyse(matrix);
  ASSERT_TRUE(lu.factorise(matrix));
  for (const double unit : {1e-30, 1.0, 1e30}) {
    auto b = random_vector(unknowns(matrix), random);
    for (double& value : b) value *= unit;
    Iterative iterative;
    iterative.prepare(matrix, regularisation_of(matrix, 1e-12));
    std::vector<One> x(matrix.nodes);
    const auto right = by_node(matrix, b);
    EXPECT_LE(iterative.solve<One>(matrix, right, x, {1e-11, 0, 400}), 1e-11);
    EXPECT_LE(difference(by_component(matrix, x), solve(lu, matrix, b)), 1e-8);
    EXPECT_LE(iterative.products, 400);
  }
}

}  // namespace
}  // namespace grainlaw::core::test
