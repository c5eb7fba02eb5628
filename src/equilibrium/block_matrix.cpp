#include "equilibrium/block_matrix.hpp"

#include "room.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>

namespace grainlaw {

void BlockMatrix::reset(std::size_t node_count, int component_count, std::span<const Edge> graph) {
  nodes = node_count;
  components = component_count;
  stride = component_count == 3 ? 4 : component_count;
  resize_with_room(edges, graph.size());
  std::copy(graph.begin(), graph.end(), edges.begin());
  resize_with_room(diagonal, nodes * block_size());
  resize_with_room(upper, edges.size() * block_size());
  resize_with_room(lower, edges.size() * block_size());
  set_zero();
}

void BlockMatrix::set_zero() {
  std::fill(diagonal.begin(), diagonal.end(), 0.0);
  std::fill(upper.begin(), upper.end(), 0.0);
  std::fill(lower.begin(), lower.end(), 0.0);
}

void BlockMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  const auto b = static_cast<std::size_t>(components);
  const auto s = static_cast<std::size_t>(stride);
  std::fill(y.begin(), y.end(), 0.0);
  const auto add = [&](const double* block, std::size_t row, std::size_t column) {
    for (std::size_t c = 0; c < b; ++c) {
      for (std::size_t r = 0; r < b; ++r) {
        y[r * nodes + row] += block[c * s + r] * x[c * nodes + column];
      }
    }
  };
  for (std::size_t q = 0; q < nodes; ++q) add(diagonal.data() + q * block_size(), q, q);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto p = static_cast<std::size_t>(edges[e].first);
    const auto q = static_cast<std::size_t>(edges[e].second);
    add(upper.data() + e * block_size(), p, q);
    add(lower.data() + e * block_size(), q, p);
  }
}

bool solve_with_pivoting(const BlockMatrix& matrix, std::span<const double> b,
                         std::span<double> x) {
  const auto n = static_cast<Eigen::Index>(b.size());
  const auto nodes = static_cast<Eigen::Index>(matrix.nodes);
  std::vector<Eigen::Triplet<double>> triplets;
  const auto add = [&](const double* block, Eigen::Index row, Eigen::Index column) {
    for (int c = 0; c < matrix.components; ++c) {
      for (int r = 0; r < matrix.components; ++r) {
        triplets.emplace_back(r * nodes + row, c * nodes + column, block[c * matrix.stride + r]);
      }
    }
  };
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    add(matrix.diagonal.data() + q * matrix.block_size(), static_cast<Eigen::Index>(q),
        static_cast<Eigen::Index>(q));
  }
  for (std::size_t e = 0; e < matrix.edges.size(); ++e) {
    const auto [p, q] = matrix.edges[e];
    add(matrix.upper.data() + e * matrix.block_size(), p, q);
    add(matrix.lower.data() + e * matrix.block_size(), q, p);
  }
  Eigen::SparseMatrix<double> sparse(n, n);
  sparse.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(sparse);
  if (lu.info() != Eigen::Success) return false;
  Eigen::Map<Eigen::VectorXd>(x.data(), n) =
      lu.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
  return lu.info() == Eigen::Success;
}

}  // namespace grainlaw
