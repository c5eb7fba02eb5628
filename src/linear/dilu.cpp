// Factorisation.
#include "linear/dilu.hpp"

#include "base/capacity.hpp"
#include "linear/dense_block.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainlaw::core {

using namespace simd;

namespace {

constexpr std::size_t b = Dilu::size;
constexpr std::size_t width = Dilu::width;
using Block = Dilu::Block<double>;
using Triangle = Dilu::Triangle;
using V = Lanes<width>;

std::size_t at(std::int32_t place) { return static_cast<std::size_t>(place); }

struct Factorisation {
  const BlockMatrix<width>& matrix;
  const BlockColumn<width>* regularisation;
  const std::int32_t* node;
  const std::size_t *block_of_lower, *block_of_upper;
  const std::int32_t* upper_of_lower;
  const Triangle &lower, &upper;
  Dilu::Values<double>& to;
};

GRAINLAW_INLINE Block scaled(const BlockColumn<width>* a, const BlockColumn<width>& row,
                             const BlockColumn<width>& column) {
  Block result;
#pragma GCC unroll 6
  for (std::size_t c = 0; c < b; ++c) {
    store(result.column[c].lane, load<width>(a[c].lane) * load<width>(row.lane) * column.lane[c]);
  }
  return result;
}

// Adds factor x y to `to`.
GRAINLAW_INLINE void add_product(Block& to, double factor, const Block& x, const Block& y) {
#pragma GCC unroll 6
  for (std::size_t c = 0; c < b; ++c) {
    V sum = load<width>(to.column[c].lane);
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) {
      sum += load<width>(x.column[k].lane) * (factor * y.column[c].lane[k]);
    }
    store(to.column[c].lane, sum);
  }
}

// Inverse of a block; the identity for a singular one, since scaled blocks are of that size.
Block inverse_of(const Block& given) {
  Block block = given;
  Block result{};
  double* const a = block.column[0].lane;
  dense::Pivot pivot;
  const bool regular = dense::triangulate<b>(a, pivot);
  for (std::size_t c = 0; c < b; ++c) {
    double x[b];
    const auto unit = [c](std::size_t row) { return row == c ? 1.0 : 0.0; };
    if (regular) {
      dense::divide_column<b>(x, a, width, pivot, unit);
    } else {
      for (std::size_t r = 0; r < b; ++r) x[r] = unit(r);
    }
    std::copy_n(x, b, result.column[c].lane);
  }
  return result;
}

void find_scale(const Factorisation& v) {
  for (std::size_t q = 0; q < v.matrix.nodes; ++q) {
    const std::size_t node = at(v.node[q]);
    v.to.scale[q] = {};
    for (std::size_t k = 0; k < b; ++k) {
      const double value =
          std::abs(v.matrix.block(node)[k].lane[k]) + v.regularisation[node].lane[k];
      v.to.scale[q].lane[k] = 1 / std::sqrt(value);
    }
  }
}

GRAINLAW_CLONES void factorise_rows(const Factorisation& v) {
  const auto& matrix = v.matrix;
  for (std::size_t q = 0; q < matrix.nodes; ++q) {
    const std::size_t node = at(v.node[q]);
    const auto& row = v.to.scale[q];
    const Block own = scaled(matrix.block(node), row, row);
    Block pivot = own;
    for (std::size_t k = 0; k < b; ++k) {
      pivot.column[k].lane[k] += v.regularisation[node].lane[k] * row.lane[k] * row.lane[k];
    }
    for (std::size_t k = v.lower.begin[q]; k < v.lower.begin[q + 1]; ++k) {
      v.to.lower[k] =
          scaled(matrix.block(v.block_of_lower[k]), row, v.to.scale[at(v.lower.node[k])]);
      add_product(pivot, 1, v.to.lower[k], v.to.upper[at(v.upper_of_lower[k])]);
    }
    const Block inverse = v.to.inverse[q] = inverse_of(pivot);
    for (std::size_t k = v.lower.begin[q]; k < v.lower.begin[q + 1]; ++k) {
      const Block block = v.to.lower[k];
      v.to.lower[k] = {};
      add_product(v.to.lower[k], -1, inverse, block);
    }
    for (std::size_t k = v.upper.begin[q]; k < v.upper.begin[q + 1]; ++k) {
      v.to.upper[k] = {};
      add_product(v.to.upper[k], -1, inverse,
                  scaled(matrix.block(v.block_of_upper[k]), row, v.to.scale[at(v.upper.node[k])]));
    }
    v.to.diagonal[q] = {};
    add_product(v.to.diagonal[q], 1, inverse, own);
    for (std::size_t k = 0; k < b; ++k) v.to.diagonal[q].column[k].lane[k] -= 2;
  }
}

GRAINLAW_CLONES void round_to_single(const double* from, std::size_t count, float* to) {
  for (std::size_t k = 0; k < count; ++k) to[k] = static_cast<float>(from[k]);
}

}  // namespace

// Lists edges as rows of both triangles, each row in the level order.
void Dilu::list_rows() {
  order_.find(nodes_, edges_);
  const auto place = order_.place();
  for (Triangle* triangle : {&lower_, &upper_}) {
    resize_with_capacity(triangle->begin, nodes_ + 1);
    std::fill(triangle->begin.begin(), triangle->begin.end(), 0);
    resize_with_capacity(triangle->node, edges_.size());
  }
  for (const auto& [p, q] : edges_) {
    ++upper_.begin[at(std::min(place[at(p)], place[at(q)])) + 1];
    ++lower_.begin[at(std::max(place[at(p)], place[at(q)])) + 1];
  }
  const auto start = [this](Triangle& triangle, std::vector<std::size_t>& next) {
    std::partial_sum(triangle.begin.begin(), triangle.begin.end(), triangle.begin.begin());
    resize_with_capacity(next, nodes_);
    std::copy_n(triangle.begin.begin(), nodes_, next.begin());
  };
  start(upper_, next_);
  start(lower_, next_lower_);
  for (auto* blocks : {&block_of_lower_, &block_of_upper_})
    resize_with_capacity(*blocks, edges_.size());
  resize_with_capacity(upper_of_lower_, edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const std::int32_t p = place[at(edges_[e].first)];
    const std::int32_t q = place[at(edges_[e].second)];
    const std::size_t above = next_[at(std::min(p, q))]++;
    const std::size_t below = next_lower_[at(std::max(p, q))]++;
    upper_.node[above] = std::max(p, q);
    lower_.node[below] = std::min(p, q);
    upper_of_lower_[below] = static_cast<std::int32_t>(above);
    block_of_upper_[above] = p < q ? nodes_ + e : nodes_ + edges_.size() + e;
    block_of_lower_[below] = p < q ? nodes_ + edges_.size() + e : nodes_ + e;
  }
}

void Dilu::factorise(const BlockMatrix<width>& matrix, std::span<const Column> regularisation) {
  const auto size = [this](auto& values) {
    for (auto* column : {&values.scale, &values.half, &values.rest}) {
      resize_with_capacity(*column, nodes_);
    }
    for (auto* blocks : {&values.inverse, &values.diagonal}) resize_with_capacity(*blocks, nodes_);
    for (auto* blocks : {&values.lower, &values.upper}) {
      resize_with_capacity(*blocks, edges_.size());
    }
    for (auto* several : {&values.half_together, &values.rest_together}) {
      reserve_with_capacity(*several, b * nodes_);
    }
  };
  const bool known = nodes_ == matrix.nodes && edges_ == matrix.edges;
  if (!known) {
    nodes_ = matrix.nodes;
    copy_with_capacity(matrix.edges, edges_);
    list_rows();
    size(double_);
    size(single_);
  }
  const Factorisation factorisation{matrix,
                                    regularisation.data(),
                                    order_.node().data(),
                                    block_of_lower_.data(),
                                    block_of_upper_.data(),
                                    upper_of_lower_.data(),
                                    lower_,
                                    upper_,
                                    double_};
  find_scale(factorisation);
  factorise_rows(factorisation);
  const auto round = [](const auto& from, auto& to) {
    round_to_single(reinterpret_cast<const double*>(from.data()),
                    from.size() * sizeof from[0] / sizeof(double),
                    reinterpret_cast<float*>(to.data()));
  };
  round(double_.scale, single_.scale);
  round(double_.inverse, single_.inverse);
  round(double_.diagonal, single_.diagonal);
  round(double_.lower, single_.lower);
  round(double_.upper, single_.upper);
}

}  // namespace grainlaw::core
