// Sweeps through the factors.
#include "base/capacity.hpp"
#include "linear/dilu.hpp"

#include <type_traits>
#include <utility>

namespace grainlaw::core {

using namespace simd;

namespace {

constexpr std::size_t b = Dilu::size;
constexpr std::size_t width = Dilu::width;
using Triangle = Dilu::Triangle;
template <class Real>
using Block = Dilu::Block<Real>;
template <class Real>
using Factors = Dilu::Factors<Real>;
template <class Real>
using V = Lanes<width, Real>;

// Unknowns of a node for one vector, one per lane.
template <class Real_>
struct OfOne {
  using Real = Real_;
  static constexpr std::size_t stride = width;
  V<Real> value;

  GRAINLAW_INLINE explicit OfOne(const Real* from) : value(load<width>(from)) {}
  GRAINLAW_INLINE OfOne(const double* from, const double* factor)
      : value(__builtin_convertvector(load<width>(from) * load<width>(factor), V<Real>)) {}
  GRAINLAW_INLINE void store_to(Real* to) const { store(to, value); }
  GRAINLAW_INLINE void store_to(double* to, const double* factor) const {
    store(to, __builtin_convertvector(value, V<double>) * load<width>(factor));
  }
  GRAINLAW_INLINE void add(const Real* x) { value += load<width>(x); }
  GRAINLAW_INLINE void scale(const BlockColumn<width, Real>& by) { value *= load<width>(by.lane); }
  GRAINLAW_INLINE void add_product(const Block<Real>& a, const Real* x) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) value += load<width>(a.column[c].lane) * x[c];
  }
};

// Unknowns of a node for several vectors, one vector per lane.
template <class Real_>
struct OfSeveral {
  using Real = Real_;
  static constexpr std::size_t stride = b * width;
  V<Real> value[b];

  GRAINLAW_INLINE explicit OfSeveral(const Real* from) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) value[k] = load<width>(from + k * width);
  }
  GRAINLAW_INLINE OfSeveral(const double* from, const double* factor) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) {
      value[k] =
          __builtin_convertvector(load<width>(from + k * width) * load<width>(factor), V<Real>);
    }
  }
  GRAINLAW_INLINE void store_to(Real* to) const {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) store(to + k * width, value[k]);
  }
  GRAINLAW_INLINE void store_to(double* to, const double* factor) const {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) {
      store(to + k * width, __builtin_convertvector(value[k], V<double>) * load<width>(factor));
    }
  }
  GRAINLAW_INLINE void add(const Real* x) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) value[k] += load<width>(x + k * width);
  }
  GRAINLAW_INLINE void scale(const BlockColumn<width, Real>& by) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < b; ++k) value[k] *= by.lane[k];
  }
  GRAINLAW_INLINE void add_product(const Block<Real>& a, const Real* x) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) {
      const V<Real> from = load<width>(x + c * width);
#pragma GCC unroll 6
      for (std::size_t k = 0; k < b; ++k) value[k] += a.column[c].lane[k] * from;
    }
  }
};

template <class Unknowns>
using RealOf = typename Unknowns::Real;
template <class Unknowns>
using FactorsOf = Factors<RealOf<Unknowns>>;

template <class Unknowns>
GRAINLAW_INLINE void add_row(Unknowns& sum, const Triangle& triangle,
                             const Block<RealOf<Unknowns>>* blocks, std::size_t row,
                             const RealOf<Unknowns>* x) {
  for (std::size_t k = triangle.begin[row]; k < triangle.begin[row + 1]; ++k) {
    sum.add_product(blocks[k], x + static_cast<std::size_t>(triangle.node[k]) * Unknowns::stride);
  }
}

// Computes x <- (1 + D^-1 U)^-1 y.
template <class Unknowns>
GRAINLAW_INLINE void sweep_back(const FactorsOf<Unknowns>& f, const RealOf<Unknowns>* y,
                                RealOf<Unknowns>* x) {
  for (std::size_t q = f.nodes; q-- > 0;) {
    Unknowns sum(y + q * Unknowns::stride);
    add_row(sum, f.upper, f.upper_blocks, q, x);
    sum.store_to(x + q * Unknowns::stride);
  }
}

// Position of a row's node in vectors by nodes.
template <class Unknowns>
GRAINLAW_INLINE std::size_t place_of(const FactorsOf<Unknowns>& f, std::size_t row) {
  return static_cast<std::size_t>(f.node[row]) * Unknowns::stride;
}

template <class Unknowns>
GRAINLAW_INLINE void backward_of(const FactorsOf<Unknowns>& f, const RealOf<Unknowns>* y,
                                 RealOf<Unknowns>* half, const double* factor, double* x) {
  sweep_back<Unknowns>(f, y, half);
  for (std::size_t q = 0; q < f.nodes; ++q) {
    Unknowns value(half + q * Unknowns::stride);
    value.scale(f.scale[q]);
    value.store_to(x + place_of<Unknowns>(f, q), factor);
  }
}

template <class Unknowns>
GRAINLAW_INLINE void forward_of(const FactorsOf<Unknowns>& f, const double* right,
                                const double* factor, RealOf<Unknowns>* c) {
  using Real = RealOf<Unknowns>;
  alignas(64) Real own[Unknowns::stride];
  constexpr Real zero[Unknowns::stride] = {};
  for (std::size_t q = 0; q < f.nodes; ++q) {
    Unknowns value(right + place_of<Unknowns>(f, q), factor);
    value.scale(f.scale[q]);
    value.store_to(own);
    Unknowns sum(zero);
    sum.add_product(f.inverse[q], own);
    add_row(sum, f.lower, f.lower_blocks, q, c);
    sum.store_to(c + q * Unknowns::stride);
  }
}

// Computes c = (1 + D^-1 L)^-1 D^-1 A (1 + D^-1 U)^-1 y
// = x + (1 + D^-1 L)^-1 (y + (D^-1 A_qq - 2) x).
template <class Unknowns>
GRAINLAW_INLINE void apply_of(const FactorsOf<Unknowns>& f, const RealOf<Unknowns>* y,
                              RealOf<Unknowns>* x, RealOf<Unknowns>* rest, RealOf<Unknowns>* c) {
  sweep_back<Unknowns>(f, y, x);
  for (std::size_t q = 0; q < f.nodes; ++q) {
    const std::size_t place = q * Unknowns::stride;
    Unknowns sum(y + place);
    sum.add_product(f.diagonal[q], x + place);
    add_row(sum, f.lower, f.lower_blocks, q, rest);
    sum.store_to(rest + place);
    sum.add(x + place);
    sum.store_to(c + place);
  }
}

#define GRAINLAW_SWEEPS(Of, Entry, Real)                                                   \
  GRAINLAW_CLONES void sweep_backward(const Factors<Real>& f, const Entry* y, Entry* half, \
                                      const double* factor, double* x) {                   \
    backward_of<Of<Real>>(f, y->lane, half->lane, factor, x);                              \
  }                                                                                        \
  GRAINLAW_CLONES void sweep_forward(const Factors<Real>& f, const double* right,          \
                                     const double* factor, Entry* c) {                     \
    forward_of<Of<Real>>(f, right, factor, c->lane);                                       \
  }                                                                                        \
  GRAINLAW_CLONES void sweep_both(const Factors<Real>& f, const Entry* y, Entry* half,     \
                                  Entry* rest, Entry* c) {                                 \
    apply_of<Of<Real>>(f, y->lane, half->lane, rest->lane, c->lane);                       \
  }
using Column = BlockColumn<width>;
using SingleColumn = BlockColumn<width, float>;
using Several = Together<width>;
using SingleSeveral = Together<width, float>;
GRAINLAW_SWEEPS(OfOne, Column, double)
GRAINLAW_SWEEPS(OfOne, SingleColumn, float)
GRAINLAW_SWEEPS(OfSeveral, Several, double)
GRAINLAW_SWEEPS(OfSeveral, SingleSeveral, float)

template <class Entry>
using RealIn = std::remove_cvref_t<decltype(Entry{}.lane[0])>;

// Memory of a sweep for vectors of this kind.
template <class Entry, class Values>
auto memory(Values& values, std::size_t count) {
  if constexpr (requires(Entry * entry) { entry = values.half.data(); }) {
    return std::pair{values.half.data(), values.rest.data()};
  } else {
    resize_with_capacity(values.half_together, count);
    resize_with_capacity(values.rest_together, count);
    return std::pair{values.half_together.data(), values.rest_together.data()};
  }
}

}  // namespace

template <class Entry>
void Dilu::forward(std::span<const InDouble<Entry>> right, const double* factor,
                   std::span<Entry> c) {
  sweep_forward(factors<RealIn<Entry>>(), right.data()->lane, factor, c.data());
}

template <class Entry>
void Dilu::backward(std::span<const Entry> y, const double* factor, std::span<InDouble<Entry>> x) {
  const auto [half, rest] = memory<Entry>(values<RealIn<Entry>>(), y.size());
  sweep_backward(factors<RealIn<Entry>>(), y.data(), half, factor, x.data()->lane);
}

template <class Entry>
void Dilu::apply(std::span<const Entry> y, std::span<Entry> c) {
  const auto [half, rest] = memory<Entry>(values<RealIn<Entry>>(), y.size());
  sweep_both(factors<RealIn<Entry>>(), y.data(), half, rest, c.data());
}

#define GRAINLAW_FOR(Entry)                                                                        \
  template void Dilu::forward(std::span<const InDouble<Entry>>, const double*, std::span<Entry>);  \
  template void Dilu::backward(std::span<const Entry>, const double*, std::span<InDouble<Entry>>); \
  template void Dilu::apply(std::span<const Entry>, std::span<Entry>);
GRAINLAW_FOR(Column)
GRAINLAW_FOR(SingleColumn)
GRAINLAW_FOR(Several)
GRAINLAW_FOR(SingleSeveral)

}  // namespace grainlaw::core
