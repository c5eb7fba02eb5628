// Random block matrices over random planar graphs, and the same dense.
#pragma once

#include "linear/block_lu.hpp"
#include "linear/block_matrix.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace grainlaw::core::test {

// Points in a square, joined when near: as planar as the contacts of discs.
inline std::vector<Edge> near_pairs(std::size_t nodes, std::mt19937& random) {
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

inline std::vector<double> random_vector(std::size_t size, std::mt19937& random) {
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

inline Eigen::VectorXd as_eigen(const std::vector<double>& values) {
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
BlockMatrix<width> random_matrix(std::size_t nodes, BlockSize<width> components,
                                 std::mt19937& random) {
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
  static constexpr std::array components{blocks_of_2, blocks_of_3};
};
struct ColumnsOfEight {
  static constexpr std::size_t width = 8;
  static constexpr std::array components{blocks_of_6};
};

template <class Columns>
struct OfColumns : testing::Test, Columns {
  using Matrix = BlockMatrix<Columns::width>;
  using LU = BlockLU<Columns::width>;
  static constexpr BlockSize<Columns::width> least = Columns::components.front();
  static constexpr BlockSize<Columns::width> most = Columns::components.back();
};
using EveryColumns = testing::Types<ColumnsOfFour, ColumnsOfEight>;

}  // namespace grainlaw::core::test
