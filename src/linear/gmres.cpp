#include "linear/gmres.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

using namespace simd;

namespace {

template <std::size_t width>
GRAINLAW_INLINE double dot_of(std::span<const BlockColumn<width>> a,
                              std::span<const BlockColumn<width>> b) {
  Lanes<width> total{};
  for (std::size_t k = 0; k < a.size(); ++k) {
    total += load<width>(a[k].lane) * load<width>(b[k].lane);
  }
  return simd::sum(total);
}
GRAINLAW_CLONES double dot(std::span<const BlockColumn<4>> a, std::span<const BlockColumn<4>> b) {
  return dot_of<4>(a, b);
}
GRAINLAW_CLONES double dot(std::span<const BlockColumn<8>> a, std::span<const BlockColumn<8>> b) {
  return dot_of<8>(a, b);
}

template <std::size_t width>
double length_of(std::span<const BlockColumn<width>> a) {
  return std::sqrt(dot(a, a));
}

// Adds factor x values to `to`.
template <std::size_t width>
GRAINLAW_INLINE void add_multiple_of(std::span<BlockColumn<width>> to, double factor,
                                     std::span<const BlockColumn<width>> values) {
  for (std::size_t k = 0; k < to.size(); ++k) {
    store(to[k].lane, load<width>(to[k].lane) + factor * load<width>(values[k].lane));
  }
}
GRAINLAW_CLONES void add_multiple(std::span<BlockColumn<4>> to, double factor,
                                  std::span<const BlockColumn<4>> values) {
  add_multiple_of<4>(to, factor, values);
}
GRAINLAW_CLONES void add_multiple(std::span<BlockColumn<8>> to, double factor,
                                  std::span<const BlockColumn<8>> values) {
  add_multiple_of<8>(to, factor, values);
}

template <std::size_t width>
void scale(std::span<BlockColumn<width>> values, double factor) {
  for (auto& value : values) store(value.lane, factor * load<width>(value.lane));
}

}  // namespace

template <std::size_t width>
void Gmres<width>::reserve(std::size_t nodes) {
  basis_.reserve((directions + 1) * nodes);
  work_.reserve(nodes);
}

template <std::size_t width>
void Gmres<width>::solve(const BlockMatrix<width>& matrix, BlockLU<width>& lu, double tolerance,
                         std::span<const Column> b, std::span<Column> x) {
  constexpr double helps = 0.5;  // least reduction of the residual by a useful cycle
  nodes_ = matrix.nodes;
  basis_.resize((directions + 1) * nodes_);
  work_.resize(nodes_);
  std::fill(x.begin(), x.end(), Column{});
  const double enough = tolerance * length_of<width>(b);
  double last = std::numeric_limits<double>::infinity();
  for (int restart = 0; restart < cycles; ++restart) {
    const auto residual = direction(0);
    matrix.residual(b, x, residual);
    const double length = length_of<width>(residual);
    if (!(length > enough) || !(length < helps * last)) return;
    last = length;
    scale<width>(residual, 1 / length);
    add_correction(lu, find_directions(matrix, lu, length, enough), x);
  }
}

// Arnoldi process with Givens rotations, from the direction of the residual on. Returns the number
// of useful directions.
template <std::size_t width>
std::size_t Gmres<width>::find_directions(const BlockMatrix<width>& matrix, BlockLU<width>& lu,
                                          double length, double enough) {
  constexpr double independent = 1e-12;  // least new part of A times a direction
  right_ = {};
  right_[0] = length;
  for (std::size_t k = 0; k < directions; ++k) {
    auto& column = hessenberg_[k];
    const auto next = direction(k + 1);
    std::copy_n(direction(k).begin(), nodes_, work_.begin());
    lu.solve(work_);
    std::fill(next.begin(), next.end(), Column{});
    matrix.subtract_product(work_, next);
    scale<width>(next, -1);
    const double whole = length_of<width>(next);
    for (std::size_t l = 0; l <= k; ++l) {
      column[l] = dot(direction(l), next);
      add_multiple(next, -column[l], direction(l));
    }
    column[k + 1] = length_of<width>(next);
    if (column[k + 1] > 0) scale<width>(next, 1 / column[k + 1]);
    for (std::size_t l = 0; l < k; ++l) rotate(l, column[l], column[l + 1]);
    const double radius = std::hypot(column[k], column[k + 1]);
    if (!(radius > independent * whole)) return k;
    cosine_[k] = column[k] / radius;
    sine_[k] = column[k + 1] / radius;
    rotate(k, column[k], column[k + 1]);
    rotate(k, right_[k], right_[k + 1]);
    if (std::abs(right_[k + 1]) <= enough) return k + 1;
  }
  return directions;
}

template <std::size_t width>
void Gmres<width>::rotate(std::size_t k, double& upper, double& lower) const {
  const double turned = cosine_[k] * upper + sine_[k] * lower;
  lower = cosine_[k] * lower - sine_[k] * upper;
  upper = turned;
}

// Adds the combination of directions with the least residual.
template <std::size_t width>
void Gmres<width>::add_correction(BlockLU<width>& lu, std::size_t count, std::span<Column> x) {
  std::fill(work_.begin(), work_.end(), Column{});
  for (std::size_t k = count; k-- > 0;) {
    for (std::size_t l = k + 1; l < count; ++l) right_[k] -= hessenberg_[l][k] * right_[l];
    right_[k] /= hessenberg_[k][k];
    add_multiple(std::span(work_), right_[k], direction(k));
  }
  lu.solve(work_);
  add_multiple(x, 1, std::span<const Column>(work_));
}

template class Gmres<4>;
template class Gmres<8>;

}  // namespace grainlaw::core
