#include "linear/gmres.hpp"

#include "linear/quad.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

using namespace quad;

namespace {

GRAINLAW_CLONES double dot(std::span<const Quad> a, std::span<const Quad> b) {
  Lanes total{};
  for (std::size_t k = 0; k < a.size(); ++k) total += load(a[k].lane) * load(b[k].lane);
  return simd::sum(total);
}

double length_of(std::span<const Quad> a) { return std::sqrt(dot(a, a)); }

// to += factor x values.
GRAINLAW_CLONES void add_multiple(std::span<Quad> to, double factor, std::span<const Quad> values) {
  for (std::size_t k = 0; k < to.size(); ++k) {
    store(to[k].lane, load(to[k].lane) + factor * load(values[k].lane));
  }
}

void scale(std::span<Quad> values, double factor) {
  for (auto& value : values) store(value.lane, factor * load(value.lane));
}

}  // namespace

void Gmres::reserve(std::size_t nodes) {
  basis_.reserve((directions + 1) * nodes);
  work_.reserve(nodes);
}

void Gmres::solve(const BlockMatrix& matrix, BlockLU& lu, double tolerance, std::span<const Quad> b,
                  std::span<Quad> x) {
  constexpr double helps = 0.5;  // a cycle that leaves less of the residual
  nodes_ = matrix.nodes;
  basis_.resize((directions + 1) * nodes_);
  work_.resize(nodes_);
  std::fill(x.begin(), x.end(), Quad{});
  const double enough = tolerance * length_of(b);
  double last = std::numeric_limits<double>::infinity();
  for (int restart = 0; restart < cycles; ++restart) {
    const auto residual = direction(0);
    matrix.residual(b, x, residual);
    const double length = length_of(residual);
    if (!(length > enough) || !(length < helps * last)) return;
    last = length;
    scale(residual, 1 / length);
    add_correction(lu, find_directions(matrix, lu, length, enough), x);
  }
}

// The Arnoldi process with Givens rotations, from the residual's direction on. Returns how many
// directions are of use.
std::size_t Gmres::find_directions(const BlockMatrix& matrix, BlockLU& lu, double length,
                                   double enough) {
  constexpr double independent = 1e-12;  // of a direction: what A makes of it that is new
  right_ = {};
  right_[0] = length;
  for (std::size_t k = 0; k < directions; ++k) {
    auto& column = hessenberg_[k];
    const auto next = direction(k + 1);
    std::copy_n(direction(k).begin(), nodes_, work_.begin());
    lu.solve(work_);
    std::fill(next.begin(), next.end(), Quad{});
    matrix.subtract_product(work_, next);
    scale(next, -1);
    const double whole = length_of(next);
    for (std::size_t l = 0; l <= k; ++l) {
      column[l] = dot(direction(l), next);
      add_multiple(next, -column[l], direction(l));
    }
    column[k + 1] = length_of(next);
    if (column[k + 1] > 0) scale(next, 1 / column[k + 1]);
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

void Gmres::rotate(std::size_t k, double& upper, double& lower) const {
  const double turned = cosine_[k] * upper + sine_[k] * lower;
  lower = cosine_[k] * lower - sine_[k] * upper;
  upper = turned;
}

// The combination of directions that leaves the least residual.
void Gmres::add_correction(BlockLU& lu, std::size_t count, std::span<Quad> x) {
  std::fill(work_.begin(), work_.end(), Quad{});
  for (std::size_t k = count; k-- > 0;) {
    for (std::size_t l = k + 1; l < count; ++l) right_[k] -= hessenberg_[l][k] * right_[l];
    right_[k] /= hessenberg_[k][k];
    add_multiple(work_, right_[k], direction(k));
  }
  lu.solve(work_);
  add_multiple(x, 1, work_);
}

}  // namespace grainlaw
