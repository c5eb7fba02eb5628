#include "linear/krylov.hpp"
#include "linear/krylov_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace grainlaw::core {

using namespace simd;

namespace {

constexpr std::size_t width = Dilu::width;
constexpr std::size_t most = 4;  // number of shadows
using V = Lanes<width>;

struct Shadows {
  std::array<const double*, most> of;
};

// Products with the shadows, and with itself; `each` is the count of a shadow's numbers per
// register.
template <std::size_t each>
GRAINLAW_INLINE void project(const Shadows& shadows, const double* a, std::size_t count,
                             double* const* result, double* square) {
  V by[most] = {};
  V own{};
  for (std::size_t k = 0; k < count; ++k) {
    const V value = load<width>(a + k * width);
    own += value * value;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < most; ++i) {
      if constexpr (each == 1) {
        by[i] += value * shadows.of[i][k];
      } else {
        by[i] += value * load<width>(shadows.of[i] + k * width);
      }
    }
  }
  for (std::size_t i = 0; i < most; ++i) store(result[i], by[i]);
  store(square, own);
}
GRAINLAW_CLONES void project_one(const Shadows& shadows, const double* a, std::size_t count,
                                 double* const* result, double* square) {
  project<width>(shadows, a, count, result, square);
}
GRAINLAW_CLONES void project_several(const Shadows& shadows, const double* a, std::size_t count,
                                     double* const* result, double* square) {
  project<1>(shadows, a, count, result, square);
}

struct Space {
  std::array<double*, most> moves, images;
  const double* factor[most];
};

// Finds the next direction omega (r - sum c_i image_i) + sum c_i move_i, with i from k on.
GRAINLAW_CLONES void find_move(const Space& space, std::size_t k, const double* omega,
                               const double* r, std::size_t count) {
  V c[most];
  for (std::size_t i = k; i < most; ++i) c[i] = load<width>(space.factor[i]);
  const V by = load<width>(omega);
  for (std::size_t q = 0; q < count; ++q) {
    const std::size_t at = q * width;
    V rest = load<width>(r + at);
    V move{};
    for (std::size_t i = k; i < most; ++i) {
      rest -= c[i] * load<width>(space.images[i] + at);
      move += c[i] * load<width>(space.moves[i] + at);
    }
    store(space.moves[k] + at, move + by * rest);
  }
}

// Projects the earlier directions out of move k and its image, then steps along it: y and r.
GRAINLAW_CLONES void take_move(const Space& space, std::size_t k, const double* beta, double* y,
                               double* r, std::size_t count, double* square) {
  V c[most];
  for (std::size_t i = 0; i < k; ++i) c[i] = load<width>(space.factor[i]);
  const V by = load<width>(beta);
  V own{};
  for (std::size_t q = 0; q < count; ++q) {
    const std::size_t at = q * width;
    V move = load<width>(space.moves[k] + at);
    V image = load<width>(space.images[k] + at);
    for (std::size_t i = 0; i < k; ++i) {
      move -= c[i] * load<width>(space.moves[i] + at);
      image -= c[i] * load<width>(space.images[i] + at);
    }
    store(space.moves[k] + at, move);
    store(space.images[k] + at, image);
    store(y + at, load<width>(y + at) + by * move);
    const V rest = load<width>(r + at) - by * image;
    store(r + at, rest);
    own += rest * rest;
  }
  store(square, own);
}

// Computes t r, t t and r r.
GRAINLAW_CLONES void compare(const double* t, const double* r, std::size_t count, double* product,
                             double* image_square, double* square) {
  V by{};
  V of_image{};
  V own{};
  for (std::size_t k = 0; k < count; ++k) {
    const V image = load<width>(t + k * width);
    const V value = load<width>(r + k * width);
    by += image * value;
    of_image += image * image;
    own += value * value;
  }
  store(product, by);
  store(image_square, of_image);
  store(square, own);
}

// Computes y += omega r and r -= omega t.
GRAINLAW_CLONES void smooth(const double* t, const double* omega, std::size_t count, double* y,
                            double* r) {
  const V by = load<width>(omega);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * width;
    const V value = load<width>(r + at);
    store(y + at, load<width>(y + at) + by * value);
    store(r + at, value - by * load<width>(t + at));
  }
}

}  // namespace

// Starts random shadows, equal for all matrices.
template <class Entry>
void Krylov<Entry>::start_shadows() {
  const std::size_t count = residual_.size() * lanes_of<Entry>::shadows;
  if (shadows_[0].size() == count) return;
  std::minstd_rand random(1);
  for (auto& shadow : shadows_) {
    shadow.resize(count);
    for (double& value : shadow) {
      value = static_cast<double>(random()) / static_cast<double>(random.max()) - 0.5;
    }
  }
}

template <class Entry>
void Krylov<Entry>::project_on_shadows(const Vector& a, Four& result, Scalars& square) const {
  Shadows of;
  double* to[shadows];
  for (std::size_t i = 0; i < shadows; ++i) {
    of.of[i] = shadows_[i].data();
    to[i] = result[i].lane;
  }
  if constexpr (lanes_of<Entry>::shadows == 1) {
    project_several(of, a[0].lane, a.size(), to, square.lane);
  } else {
    project_one(of, a[0].lane, a.size(), to, square.lane);
  }
  for (auto& values : result) lanes_of<Entry>::reduce(values.lane);
  lanes_of<Entry>::reduce(square.lane);
}

// Steps in the present space along its k-th direction.
template <class Entry>
void Krylov<Entry>::step_in_space(Dilu& dilu, std::size_t k) {
  Four factor;
  for (std::size_t i = k; i < shadows; ++i) {
    for (std::size_t l = 0; l < width; ++l) {
      double value = right_[i].lane[l];
      for (std::size_t j = k; j < i; ++j) value -= matrix_[i][j].lane[l] * factor[j].lane[l];
      factor[i].lane[l] = quotient(value, matrix_[i][i].lane[l], l);
    }
  }
  Space space;
  for (std::size_t i = 0; i < shadows; ++i) {
    space.moves[i] = moves_[i][0].lane;
    space.images[i] = images_[i][0].lane;
    space.factor[i] = factor[i].lane;
  }
  double* const r = residual_[0].lane;
  find_move(space, k, omega_.lane, r, residual_.size());
  dilu.apply<Entry>(moves_[k], images_[k]);
  Four products;
  Scalars square, beta;
  project_on_shadows(images_[k], products, square);
  for (std::size_t l = 0; l < width; ++l) {
    for (std::size_t i = 0; i < k; ++i) {
      double value = products[i].lane[l];
      for (std::size_t j = 0; j < i; ++j) value -= matrix_[i][j].lane[l] * factor[j].lane[l];
      factor[i].lane[l] = quotient(value, matrix_[i][i].lane[l], l);
    }
    for (std::size_t i = k; i < shadows; ++i) {
      double value = products[i].lane[l];
      for (std::size_t j = 0; j < k; ++j) value -= matrix_[i][j].lane[l] * factor[j].lane[l];
      matrix_[i][k].lane[l] = value;
    }
    beta.lane[l] = quotient(right_[k].lane[l], matrix_[k][k].lane[l], l);
    for (std::size_t i = k + 1; i < shadows; ++i) {
      right_[i].lane[l] -= beta.lane[l] * matrix_[i][k].lane[l];
    }
  }
  take_move(space, k, beta.lane, solution_[0].lane, r, residual_.size(), square.lane);
  lanes_of<Entry>::reduce(square.lane);
  see_residual(square);
}

// Enters the next, smaller space. Where residual and image are nearly orthogonal, the step exceeds
// the one of least residual [sleijpen1995].
template <class Entry>
void Krylov<Entry>::enter_next_space(Dilu& dilu) {
  constexpr double least_cosine = 0.7;
  const std::size_t count = residual_.size();
  image_.resize(count);
  dilu.apply<Entry>(residual_, image_);
  double* const r = residual_[0].lane;
  Scalars product, image_square, square;
  compare(image_[0].lane, r, count, product.lane, image_square.lane, square.lane);
  for (Scalars* sums : {&product, &image_square, &square}) lanes_of<Entry>::reduce(sums->lane);
  for (std::size_t l = 0; l < width; ++l) {
    const double lengths = std::sqrt(image_square.lane[l] * square.lane[l]);
    const double cosine = std::abs(product.lane[l]) / lengths;
    double& omega = omega_.lane[l];
    omega = left_[l] && lengths > 0 ? product.lane[l] / image_square.lane[l] : 0;
    if (cosine < least_cosine && cosine > 0) omega *= least_cosine / cosine;
  }
  smooth(image_[0].lane, omega_.lane, count, solution_[0].lane, r);
  project_on_shadows(residual_, right_, square);
  see_residual(square);
}

template <class Entry>
int Krylov<Entry>::idr(Dilu& dilu, std::span<const Right> b, std::span<Right> x,
                       const Scalars& tolerance, int most_products) {
  start(dilu, b, tolerance);
  start_shadows();
  for (std::size_t i = 0; i < shadows; ++i) {
    moves_[i].assign(b.size(), Entry{});
    images_[i].assign(b.size(), Entry{});
    for (std::size_t j = 0; j < shadows; ++j) {
      std::fill_n(matrix_[i][j].lane, width, i == j ? 1.0 : 0.0);
    }
  }
  std::fill_n(omega_.lane, width, 1.0);
  Scalars square;
  project_on_shadows(residual_, right_, square);
  int products = 0;
  while (products < most_products && any_left()) {
    for (std::size_t k = 0; k < shadows && any_left(); ++k, ++products) step_in_space(dilu, k);
    if (!any_left()) break;
    enter_next_space(dilu);
    ++products;
  }
  finish(dilu, x);
  return products;
}

template int Krylov<BlockColumn<8>>::idr(Dilu&, std::span<const BlockColumn<8>>,
                                         std::span<BlockColumn<8>>, const Scalars&, int);
template int Krylov<Together<8>>::idr(Dilu&, std::span<const Together<8>>, std::span<Together<8>>,
                                      const Scalars&, int);

}  // namespace grainlaw::core
