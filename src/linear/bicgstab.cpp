#include "base/capacity.hpp"
#include "linear/krylov.hpp"
#include "linear/krylov_lanes.hpp"
#include "linear/largest.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

using namespace simd;

namespace {

constexpr std::size_t width = Dilu::width;
using V = Lanes<width, float>;

// Numbers per lane, from and to double precision.
GRAINLAW_INLINE V lanes_from(const double* from) {
  return __builtin_convertvector(load<width>(from), V);
}
GRAINLAW_INLINE void put_lanes(const V& value, double* to) {
  store(to, __builtin_convertvector(value, Lanes<width>));
}

GRAINLAW_CLONES void dot(const double* a, const double* b, std::size_t count, double* result) {
  Lanes<width> sum{};
  for (std::size_t k = 0; k < count; ++k) {
    sum += load<width>(a + k * width) * load<width>(b + k * width);
  }
  store(result, sum);
}
GRAINLAW_CLONES void dot(const float* a, const float* b, std::size_t count, double* result) {
  V sum{};
  for (std::size_t k = 0; k < count; ++k) {
    sum += load<width>(a + k * width) * load<width>(b + k * width);
  }
  put_lanes(sum, result);
}

// Computes a b and a a.
GRAINLAW_CLONES void dot_and_square(const float* a, const float* b, std::size_t count,
                                    double* product, double* square) {
  V by{};
  V own{};
  for (std::size_t k = 0; k < count; ++k) {
    const V value = load<width>(a + k * width);
    by += value * load<width>(b + k * width);
    own += value * value;
  }
  put_lanes(by, product);
  put_lanes(own, square);
}

// Computes p <- r + beta (p - omega v).
GRAINLAW_CLONES void turn(const float* r, const float* v, std::size_t count, const double* beta,
                          const double* omega, float* p) {
  const V turned = lanes_from(beta);
  const V back = turned * lanes_from(omega);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * width;
    store(p + at, load<width>(r + at) + turned * load<width>(p + at) - back * load<width>(v + at));
  }
}

// Computes r -= alpha v.
GRAINLAW_CLONES void subtract(const float* v, std::size_t count, const double* alpha, float* r) {
  const V by = lanes_from(alpha);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * width;
    store(r + at, load<width>(r + at) - by * load<width>(v + at));
  }
}

struct Step {
  const float *direction, *second, *shadow;
  const double *alpha, *omega;
};

// Computes y += alpha p + omega r and r -= omega t, then shadow r and r r.
GRAINLAW_CLONES void advance(const Step& step, std::size_t count, float* y, float* r,
                             double* product, double* square) {
  const V alpha = lanes_from(step.alpha);
  const V omega = lanes_from(step.omega);
  V by{};
  V own{};
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * width;
    const V before = load<width>(r + at);
    store(y + at, load<width>(y + at) + alpha * load<width>(step.direction + at) + omega * before);
    const V after = before - omega * load<width>(step.second + at);
    store(r + at, after);
    by += after * load<width>(step.shadow + at);
    own += after * after;
  }
  put_lanes(by, product);
  put_lanes(own, square);
}

}  // namespace

template <class Entry>
void Krylov<Entry>::reserve(std::size_t nodes) {
  const std::size_t entries = nodes * lanes_of<Entry>::entries;
  for (Vector* v : {&residual_, &solution_, &image_}) reserve_with_capacity(*v, entries);
  if constexpr (in_single<Entry>) {
    for (Vector* v : {&shadow_, &direction_, &second_}) reserve_with_capacity(*v, entries);
    return;
  }
  for (std::size_t k = 0; k < shadows; ++k) {
    reserve_with_capacity(moves_[k], entries);
    reserve_with_capacity(images_[k], entries);
    reserve_with_capacity(shadows_[k], entries * lanes_of<Entry>::shadows);
  }
}

template <class Entry>
void Krylov<Entry>::start(Dilu& dilu, std::span<const Right> b, const Scalars& tolerance) {
  residual_.resize(b.size());
  solution_.assign(b.size(), Entry{});
  std::fill_n(largest_.lane, width, 1.0);
  Scalars factor = largest_;
  if constexpr (in_single<Entry>) {
    largest_by_lane<width>(b[0].lane, b.size(), largest_.lane);
    lanes_of<Entry>::find_largest(largest_.lane);
    for (std::size_t l = 0; l < width; ++l) {
      factor.lane[l] = largest_.lane[l] > 0 ? 1 / largest_.lane[l] : 0;
    }
  }
  dilu.forward<Entry>(b, factor.lane, residual_);
  Scalars square;
  dot(residual_[0].lane, residual_[0].lane, residual_.size(), square.lane);
  lanes_of<Entry>::reduce(square.lane);
  for (std::size_t l = 0; l < width; ++l) {
    enough_.lane[l] = square.lane[l] * tolerance.lane[l] * tolerance.lane[l];
    left_[l] = true;
  }
  see_residual(square);
}

template <class Entry>
void Krylov<Entry>::finish(Dilu& dilu, std::span<Right> x) {
  dilu.backward<Entry>(solution_, largest_.lane, x);
}

// Ends lanes whose residual is small enough or not a number.
template <class Entry>
void Krylov<Entry>::see_residual(const Scalars& square) {
  for (std::size_t l = 0; l < width; ++l) {
    const double value = square.lane[l];
    left_[l] = left_[l] && std::isfinite(value) && value > enough_.lane[l];
  }
}

template <class Entry>
int Krylov<Entry>::bicgstab(Dilu& dilu, std::span<const Right> b, std::span<Right> x,
                            const Scalars& tolerance, int most_products) {
  start(dilu, b, tolerance);
  const std::size_t count = b.size();
  shadow_.resize(count);
  std::copy(residual_.begin(), residual_.end(), shadow_.begin());
  for (Vector* v : {&direction_, &image_}) v->assign(count, Entry{});
  second_.resize(count);
  float* const r = residual_[0].lane;
  Scalars rho, before, alpha, omega, beta, sigma, square;
  dot(shadow_[0].lane, r, count, rho.lane);
  lanes_of<Entry>::reduce(rho.lane);
  int products = 0;
  for (; products < most_products && any_left(); products += 2) {
    for (std::size_t l = 0; l < width; ++l) {
      beta.lane[l] = products == 0 ? 0
                                   : quotient(rho.lane[l], before.lane[l], l) *
                                         quotient(alpha.lane[l], omega.lane[l], l);
    }
    turn(r, image_[0].lane, count, beta.lane, omega.lane, direction_[0].lane);
    dilu.apply<Entry>(direction_, image_);
    dot(shadow_[0].lane, image_[0].lane, count, sigma.lane);
    lanes_of<Entry>::reduce(sigma.lane);
    for (std::size_t l = 0; l < width; ++l) {
      alpha.lane[l] = quotient(rho.lane[l], sigma.lane[l], l);
    }
    subtract(image_[0].lane, count, alpha.lane, r);
    dilu.apply<Entry>(residual_, second_);
    dot_and_square(second_[0].lane, r, count, omega.lane, square.lane);
    lanes_of<Entry>::reduce(omega.lane);
    lanes_of<Entry>::reduce(square.lane);
    for (std::size_t l = 0; l < width; ++l) {
      omega.lane[l] = quotient(omega.lane[l], square.lane[l], l);
    }
    before = rho;
    advance({direction_[0].lane, second_[0].lane, shadow_[0].lane, alpha.lane, omega.lane}, count,
            solution_[0].lane, r, rho.lane, square.lane);
    lanes_of<Entry>::reduce(rho.lane);
    lanes_of<Entry>::reduce(square.lane);
    see_residual(square);
  }
  finish(dilu, x);
  return products;
}

template <class Entry>
bool Krylov<Entry>::any_left() const {
  return std::any_of(left_.begin(), left_.end(), [](bool left) { return left; });
}

#define GRAINLAW_FOR(Entry)                                                          \
  template void Krylov<Entry>::reserve(std::size_t);                                 \
  template void Krylov<Entry>::start(Dilu&, std::span<const Right>, const Scalars&); \
  template void Krylov<Entry>::finish(Dilu&, std::span<Right>);                      \
  template void Krylov<Entry>::see_residual(const Krylov<Entry>::Scalars&);          \
  template bool Krylov<Entry>::any_left() const;
GRAINLAW_FOR(BlockColumn<8>)
GRAINLAW_FOR(Together<8>)
using SingleColumn = BlockColumn<8, float>;
using SingleTogether = Together<8, float>;
GRAINLAW_FOR(SingleColumn)
GRAINLAW_FOR(SingleTogether)
template int Krylov<SingleColumn>::bicgstab(Dilu&, std::span<const BlockColumn<8>>,
                                            std::span<BlockColumn<8>>, const Scalars&, int);
template int Krylov<SingleTogether>::bicgstab(Dilu&, std::span<const Together<8>>,
                                              std::span<Together<8>>, const Scalars&, int);

}  // namespace grainlaw::core
