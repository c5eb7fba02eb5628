#include "base/capacity.hpp"
#include "linear/krylov.hpp"
#include "linear/krylov_lanes.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

using namespace simd;

namespace {

using V = Lanes<Dilu::width>;
constexpr std::size_t width = Dilu::width;

GRAINLAW_CLONES void dot(const double* a, const double* b, std::size_t count, double* result) {
  V sum{};
  for (std::size_t k = 0; k < count; ++k) {
    sum += load<width>(a + k * width) * load<width>(b + k * width);
  }
  store(result, sum);
}

// Computes a b and a a.
GRAINLAW_CLONES void dot_and_square(const double* a, const double* b, std::size_t count,
                                    double* product, double* square) {
  V by{};
  V own{};
  for (std::size_t k = 0; k < count; ++k) {
    const V value = load<width>(a + k * width);
    by += value * load<width>(b + k * width);
    own += value * value;
  }
  store(product, by);
  store(square, own);
}

// Computes p <- r + beta (p - omega v).
GRAINLAW_CLONES void turn(const double* r, const double* v, std::size_t count, const double* beta,
                          const double* omega, double* p) {
  const V turned = load<width>(beta);
  const V back = turned * load<width>(omega);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * width;
    store(p + at, load<width>(r + at) + turned * load<width>(p + at) - back * load<width>(v + at));
  }
}

// Computes r -= alpha v.
GRAINLAW_CLONES void subtract(const double* v, std::size_t count, const double* alpha, double* r) {
  const V by = load<width>(alpha);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * width;
    store(r + at, load<width>(r + at) - by * load<width>(v + at));
  }
}

struct Step {
  const double *direction, *second, *shadow;
  const double *alpha, *omega;
};

// Computes y += alpha p + omega r and r -= omega t, then shadow r and r r.
GRAINLAW_CLONES void finish(const Step& step, std::size_t count, double* y, double* r,
                            double* product, double* square) {
  const V alpha = load<width>(step.alpha);
  const V omega = load<width>(step.omega);
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
  store(product, by);
  store(square, own);
}

}  // namespace

template <class Entry>
void Krylov<Entry>::reserve(std::size_t nodes) {
  const std::size_t entries = nodes * lanes_of<Entry>::entries;
  for (Vector* v : {&residual_, &solution_, &shadow_, &direction_, &image_, &second_}) {
    reserve_with_capacity(*v, entries);
  }
  for (std::size_t k = 0; k < shadows; ++k) {
    reserve_with_capacity(moves_[k], entries);
    reserve_with_capacity(images_[k], entries);
    reserve_with_capacity(shadows_[k], entries * lanes_of<Entry>::shadows);
  }
}

template <class Entry>
void Krylov<Entry>::start(Dilu& dilu, std::span<const Entry> b, const Scalars& tolerance) {
  residual_.resize(b.size());
  solution_.assign(b.size(), Entry{});
  dilu.forward<Entry>(b, residual_);
  Scalars square;
  dot(residual_[0].lane, residual_[0].lane, residual_.size(), square.lane);
  lanes_of<Entry>::reduce(square.lane);
  for (std::size_t l = 0; l < width; ++l) {
    enough_.lane[l] = square.lane[l] * tolerance.lane[l] * tolerance.lane[l];
    left_[l] = true;
  }
  see_residual(square);
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
int Krylov<Entry>::bicgstab(Dilu& dilu, std::span<const Entry> b, std::span<Entry> x,
                            const Scalars& tolerance, int most_products) {
  start(dilu, b, tolerance);
  const std::size_t count = b.size();
  shadow_.resize(count);
  std::copy(residual_.begin(), residual_.end(), shadow_.begin());
  for (Vector* v : {&direction_, &image_}) v->assign(count, Entry{});
  second_.resize(count);
  double* const r = residual_[0].lane;
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
    finish({direction_[0].lane, second_[0].lane, shadow_[0].lane, alpha.lane, omega.lane}, count,
           solution_[0].lane, r, rho.lane, square.lane);
    lanes_of<Entry>::reduce(rho.lane);
    lanes_of<Entry>::reduce(square.lane);
    see_residual(square);
  }
  dilu.backward<Entry>(solution_, x);
  return products;
}

template <class Entry>
bool Krylov<Entry>::any_left() const {
  return std::any_of(left_.begin(), left_.end(), [](bool left) { return left; });
}

#define GRAINLAW_FOR(Entry)                                                             \
  template void Krylov<Entry>::reserve(std::size_t);                                    \
  template void Krylov<Entry>::start(Dilu&, std::span<const Entry>,                     \
                                     const Krylov<Entry>::Scalars&);                    \
  template void Krylov<Entry>::see_residual(const Krylov<Entry>::Scalars&);             \
  template bool Krylov<Entry>::any_left() const;                                        \
  template int Krylov<Entry>::bicgstab(Dilu&, std::span<const Entry>, std::span<Entry>, \
                                       const Krylov<Entry>::Scalars&, int);
GRAINLAW_FOR(BlockColumn<8>)
GRAINLAW_FOR(Together<8>)

}  // namespace grainlaw::core
