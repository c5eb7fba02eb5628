#include "linear/iterative.hpp"

#include "base/capacity.hpp"
#include "base/constants.hpp"
#include "linear/krylov_lanes.hpp"
#include "linear/largest.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace grainlaw::core {

using namespace simd;

namespace {

constexpr std::size_t width = Dilu::width;

GRAINLAW_CLONES void add(const double* a, const double* b, std::size_t count, double* sum) {
  for (std::size_t k = 0; k < count * width; k += width) {
    store(sum + k, load<width>(a + k) + load<width>(b + k));
  }
}

// Copies better lanes; the others may contain NaN.
void take_lanes(const double* from, std::size_t count, const bool* better, double* to) {
  for (std::size_t k = 0; k < count * width; k += width) {
    for (std::size_t l = 0; l < width; ++l) {
      if (better[l]) to[k + l] = from[k + l];
    }
  }
}

void residual_of(const BlockMatrix<width>& a, std::span<const BlockColumn<width>> b,
                 std::span<const BlockColumn<width>> x, std::span<BlockColumn<width>> r) {
  a.residual(b, x, r);
}
void residual_of(const BlockMatrix<width>& a, std::span<const Together<width>> b,
                 std::span<const Together<width>> x, std::span<Together<width>> r) {
  a.residual_together(b, x, r);
}

}  // namespace

template <class Entry>
auto& Iterative::memory() {
  if constexpr (std::is_same_v<Entry, Column>) {
    return one_;
  } else {
    return several_;
  }
}

void Iterative::prepare(const BlockMatrix<width>& matrix, std::span<const Column> regularisation) {
  dilu_.factorise(matrix, regularisation);
  const auto reserve = [&](auto& memory, std::size_t entries) {
    memory.single.reserve(matrix.nodes);
    memory.krylov.reserve(matrix.nodes);
    for (auto* v : {&memory.rest, &memory.step, &memory.tried}) reserve_with_capacity(*v, entries);
  };
  reserve(one_, matrix.nodes);
  reserve(several_, Dilu::size * matrix.nodes);
}

template <class Entry>
double Iterative::solve(const BlockMatrix<width>& matrix, std::span<const Entry> b,
                        std::span<Entry> x, const IterativeOptions& options) {
  constexpr double margin = 0.3;  // between the norm of the factors and the largest entry
  // Attempts of IDR: for few nodes, the caller's factors cost less than a second one.
  constexpr std::size_t few = 800;
  const int attempts = matrix.nodes < few ? 1 : 3;
  using Scalars = typename Krylov<Entry>::Scalars;
  auto& room = memory<Entry>();
  auto &rest = room.rest, &step = room.step, &tried = room.tried;
  const std::size_t count = b.size();
  for (auto* v : {&rest, &step, &tried}) v->resize(count);
  Scalars scale, error;
  const auto measure = [&](std::span<const Entry> residual) {
    Scalars result;
    largest_by_lane<width>(residual[0].lane, count, result.lane);
    lanes_of<Entry>::find_largest(result.lane);
    return result;
  };
  scale = measure(b);
  for (std::size_t l = 0; l < width; ++l) {
    const double own = scale.lane[l];
    scale.lane[l] = std::max({own, options.floor, std::numeric_limits<double>::min()});
    error.lane[l] = own / scale.lane[l];
  }
  std::fill(x.begin(), x.end(), Entry{});
  std::copy(b.begin(), b.end(), rest.begin());
  const auto worst = [&] { return *std::max_element(error.lane, error.lane + width); };
  const auto wanted = [&](double least) {
    Scalars tolerance;
    for (std::size_t l = 0; l < width; ++l) {
      const bool done = error.lane[l] <= options.tolerance;
      tolerance.lane[l] = done ? 2 : std::max(margin * options.tolerance / error.lane[l], least);
    }
    return tolerance;
  };
  // Adds the step to lanes that it makes better. Returns the least reduction of a lane.
  const auto take_step = [&] {
    add(x[0].lane, step[0].lane, count, tried[0].lane);
    residual_of(matrix, b, tried, step);
    const Scalars largest = measure(step);
    bool better[width];
    double reduction = 0;
    for (std::size_t l = 0; l < width; ++l) {
      const double now = largest.lane[l] / scale.lane[l];
      if (error.lane[l] > options.tolerance) reduction = std::max(reduction, now / error.lane[l]);
      better[l] = now < error.lane[l];
      if (better[l]) error.lane[l] = now;
    }
    take_lanes(tried[0].lane, count, better, x[0].lane);
    take_lanes(step[0].lane, count, better, rest[0].lane);
    return reduction;
  };
  for (double reduction = 0; worst() > options.tolerance && reduction < tuned::slow_cycle;) {
    products += room.single.bicgstab(dilu_, rest, step, wanted(tuned::reduction_of_cycle),
                                     std::min(options.products, tuned::products_of_cycle));
    reduction = take_step();
  }
  for (int k = 0; k < attempts && worst() > options.tolerance; ++k) {
    products += room.krylov.idr(dilu_, rest, step, wanted(0), options.products);
    take_step();
  }
  return worst();
}

template double Iterative::solve(const BlockMatrix<width>&, std::span<const BlockColumn<width>>,
                                 std::span<BlockColumn<width>>, const IterativeOptions&);
template double Iterative::solve(const BlockMatrix<width>&, std::span<const Together<width>>,
                                 std::span<Together<width>>, const IterativeOptions&);

}  // namespace grainlaw::core
