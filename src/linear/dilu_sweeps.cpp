// Sweeps through the factors.
#include "base/capacity.hpp"
#include "linear/dilu.hpp"

namespace grainlaw::core {

using namespace simd;

namespace {

constexpr std::size_t b = Dilu::size;
constexpr std::size_t width = Dilu::width;
using Block = Dilu::Block;
using Triangle = Dilu::Triangle;
using Factors = Dilu::Factors;
using V = Lanes<width>;
using Column = BlockColumn<width>;
using Several = Together<width>;

// Unknowns of a node for one vector, one per lane.
struct OfOne {
  static constexpr std::size_t stride = width;
  V value;

  GRAINLAW_INLINE explicit OfOne(const double* from) : value(load<width>(from)) {}
  GRAINLAW_INLINE void store_to(double* to) const { store(to, value); }
  GRAINLAW_INLINE void add(const double* x) { value += load<width>(x); }
  GRAINLAW_INLINE void scale(const Column& by) { value *= load<width>(by.lane); }
  GRAINLAW_INLINE void add_product(const Block& a, const double* x) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) value += load<width>(a.column[c].lane) * x[c];
  }
};

// Unknowns of a node for several vectors, one vector per lane.
struct OfSeveral {
  static constexpr std::size_t stride = b * width;
  V value[b];

  GRAINLAW_INLINE explicit OfSeveral(const double* from) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) value[k] = load<width>(from + k * width);
  }
  GRAINLAW_INLINE void store_to(double* to) const {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) store(to + k * width, value[k]);
  }
  GRAINLAW_INLINE void add(const double* x) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) value[k] += load<width>(x + k * width);
  }
  GRAINLAW_INLINE void scale(const Column& by) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) value[k] *= by.lane[k];
  }
  GRAINLAW_INLINE void add_product(const Block& a, const double* x) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) {
      const V from = load<width>(x + c * width);
#pragma GCC unroll 6
      for (std::size_t k = 0; k < b; ++k) value[k] += a.column[c].lane[k] * from;
    }
  }
};

template <class Unknowns>
GRAINLAW_INLINE void add_row(Unknowns& sum, const Triangle& triangle, std::size_t row,
                             const double* x) {
  for (std::size_t k = triangle.begin[row]; k < triangle.begin[row + 1]; ++k) {
    sum.add_product(triangle.block[k],
                    x + static_cast<std::size_t>(triangle.node[k]) * Unknowns::stride);
  }
}

// Computes x <- (1 + D^-1 U)^-1 y.
template <class Unknowns>
GRAINLAW_INLINE void sweep_back(const Factors& f, const double* y, double* x) {
  for (std::size_t q = f.nodes; q-- > 0;) {
    Unknowns sum(y + q * Unknowns::stride);
    add_row(sum, f.upper, q, x);
    sum.store_to(x + q * Unknowns::stride);
  }
}

// Position of a row's node in vectors by nodes.
template <class Unknowns>
GRAINLAW_INLINE std::size_t place_of(const Factors& f, std::size_t row) {
  return static_cast<std::size_t>(f.node[row]) * Unknowns::stride;
}

template <class Unknowns>
GRAINLAW_INLINE void backward_of(const Factors& f, const double* y, double* half, double* x) {
  sweep_back<Unknowns>(f, y, half);
  for (std::size_t q = 0; q < f.nodes; ++q) {
    Unknowns value(half + q * Unknowns::stride);
    value.scale(f.scale[q]);
    value.store_to(x + place_of<Unknowns>(f, q));
  }
}

template <class Unknowns>
GRAINLAW_INLINE void forward_of(const Factors& f, const double* right, double* c) {
  alignas(64) double own[Unknowns::stride];
  constexpr double zero[Unknowns::stride] = {};
  for (std::size_t q = 0; q < f.nodes; ++q) {
    Unknowns value(right + place_of<Unknowns>(f, q));
    value.scale(f.scale[q]);
    value.store_to(own);
    Unknowns sum(zero);
    sum.add_product(f.inverse[q], own);
    add_row(sum, f.lower, q, c);
    sum.store_to(c + q * Unknowns::stride);
  }
}

// Computes c = (1 + D^-1 L)^-1 D^-1 A (1 + D^-1 U)^-1 y
// = x + (1 + D^-1 L)^-1 (y + (D^-1 A_qq - 2) x).
template <class Unknowns>
GRAINLAW_INLINE void apply_of(const Factors& f, const double* y, double* x, double* rest,
                              double* c) {
  sweep_back<Unknowns>(f, y, x);
  for (std::size_t q = 0; q < f.nodes; ++q) {
    const std::size_t place = q * Unknowns::stride;
    Unknowns sum(y + place);
    sum.add_product(f.diagonal[q], x + place);
    add_row(sum, f.lower, q, rest);
    sum.store_to(rest + place);
    sum.add(x + place);
    sum.store_to(c + place);
  }
}

GRAINLAW_CLONES void backward_one(const Factors& f, const double* y, double* half, double* x) {
  backward_of<OfOne>(f, y, half, x);
}
GRAINLAW_CLONES void backward_several(const Factors& f, const double* y, double* half, double* x) {
  backward_of<OfSeveral>(f, y, half, x);
}
GRAINLAW_CLONES void forward_one(const Factors& f, const double* right, double* c) {
  forward_of<OfOne>(f, right, c);
}
GRAINLAW_CLONES void forward_several(const Factors& f, const double* right, double* c) {
  forward_of<OfSeveral>(f, right, c);
}
GRAINLAW_CLONES void apply_one(const Factors& f, const double* y, double* x, double* rest,
                               double* c) {
  apply_of<OfOne>(f, y, x, rest, c);
}
GRAINLAW_CLONES void apply_several(const Factors& f, const double* y, double* x, double* rest,
                                   double* c) {
  apply_of<OfSeveral>(f, y, x, rest, c);
}

}  // namespace

template <>
void Dilu::forward(std::span<const Column> right, std::span<Column> c) const {
  forward_one(factors(), right.data()->lane, c.data()->lane);
}
template <>
void Dilu::forward(std::span<const Several> right, std::span<Several> c) const {
  forward_several(factors(), right.data()->lane, c.data()->lane);
}

template <>
void Dilu::backward(std::span<const Column> y, std::span<Column> x) {
  backward_one(factors(), y.data()->lane, half_.data()->lane, x.data()->lane);
}
template <>
void Dilu::backward(std::span<const Several> y, std::span<Several> x) {
  resize_with_capacity(half_together_, y.size());
  backward_several(factors(), y.data()->lane, half_together_.data()->lane, x.data()->lane);
}

template <>
void Dilu::apply(std::span<const Column> y, std::span<Column> c) {
  apply_one(factors(), y.data()->lane, half_.data()->lane, rest_.data()->lane, c.data()->lane);
}
template <>
void Dilu::apply(std::span<const Several> y, std::span<Several> c) {
  resize_with_capacity(half_together_, y.size());
  resize_with_capacity(rest_together_, y.size());
  apply_several(factors(), y.data()->lane, half_together_.data()->lane, rest_together_.data()->lane,
                c.data()->lane);
}

}  // namespace grainlaw::core
