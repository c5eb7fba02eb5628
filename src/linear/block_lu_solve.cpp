// Solves by forward and backward substitution, front by front.
#include "linear/block_lu.hpp"
#include "linear/dense_panels.hpp"

#include "base/capacity.hpp"

#include <algorithm>

namespace grainlaw::core {

using dense::Pivot;
using dense::Shape;

namespace {

using View = Elimination::View;
using Front = Elimination::Front;

// Unknowns of a node for one vector, one per lane; padding lanes are never read.
template <std::size_t b>
struct OneVector {
  static constexpr std::size_t width = rows_of(b);
  static constexpr std::size_t size = width;
  static constexpr std::size_t backward_pivots = 4;  // at a time: sixteen registers hold their sums
  simd::Lanes<width> value;

  struct Spread {
    double by[b];
  };
  GRAINLAW_INLINE static OneVector load(const double* from) { return {simd::load<width>(from)}; }
  GRAINLAW_INLINE void store(double* to) const { simd::store(to, value); }
  GRAINLAW_INLINE Spread spread() const {
    Spread result;
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) result.by[c] = value[c];
    return result;
  }
  GRAINLAW_INLINE void add(const OneVector& other) { value += other.value; }
  // Subtracts a x; a is a block by columns, `stride` apart.
  GRAINLAW_INLINE void subtract(const double* a, std::size_t stride, const Spread& x) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) value -= simd::load<width>(a + c * stride) * x.by[c];
  }
  // Entries of a^-1 x for a pivot a, with x at `from`.
  GRAINLAW_INLINE static OneVector divide(const double* from, const double* a, std::size_t stride,
                                          const Pivot& pivot) {
    OneVector result{};
    if (!pivot.triangular) {
      result.value = simd::load<width>(a) * from[0];
#pragma GCC unroll 6
      for (std::size_t c = 1; c < b; ++c)
        result.value += simd::load<width>(a + c * stride) * from[c];
      return result;
    }
    double x[b];
    dense::divide_column<b>(x, a, stride, pivot, [&](std::size_t c) { return from[c]; });
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) result.value[c] = x[c];
    return result;
  }
};

// Unknowns of a node for several vectors, one vector per lane and one register per unknown.
template <std::size_t b>
struct Several {
  static constexpr std::size_t width = rows_of(b);
  static constexpr std::size_t size = b * width;
  static constexpr std::size_t backward_pivots = 2;
  using Spread = Several;
  simd::Lanes<width> value[b];

  GRAINLAW_INLINE static Several load(const double* from) {
    Several result;
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) result.value[c] = simd::load<width>(from + c * width);
    return result;
  }
  GRAINLAW_INLINE void store(double* to) const {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) simd::store(to + c * width, value[c]);
  }
  GRAINLAW_INLINE const Spread& spread() const { return *this; }
  GRAINLAW_INLINE void add(const Several& other) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) value[c] += other.value[c];
  }
  GRAINLAW_INLINE void subtract(const double* a, std::size_t stride, const Spread& x) {
#pragma GCC unroll 6
    for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 6
      for (std::size_t r = 0; r < b; ++r) value[r] -= a[c * stride + r] * x.value[c];
    }
  }
  GRAINLAW_INLINE static Several divide(const double* from, const double* a, std::size_t stride,
                                        const Pivot& pivot) {
    Several result;
    const auto take = [&](std::size_t c)
                          GRAINLAW_INLINED { return simd::load<width>(from + c * width); };
    if (pivot.triangular) {
      dense::divide_column<b>(result.value, a, stride, pivot, take);
      return result;
    }
#pragma GCC unroll 6
    for (std::size_t r = 0; r < b; ++r) {
      result.value[r] = a[r] * take(0);
#pragma GCC unroll 6
      for (std::size_t c = 1; c < b; ++c) result.value[r] += a[c * stride + r] * take(c);
    }
    return result;
  }
};

// Visits pivots in groups of at most four or two.
template <std::size_t most, class Visit>
GRAINLAW_INLINE void by_pivots(std::size_t pivots, const Visit& visit) {
  std::size_t k = 0;
  if constexpr (most == 4) {
    for (; k + 4 <= pivots; k += 4) visit.template operator()<4>(k);
  }
  for (; k + 2 <= pivots; k += 2) visit.template operator()<2>(k);
  if (k < pivots) visit.template operator()<1>(k);
}

// Subtracts the front's pivots from the others.
template <std::size_t b, class Unknowns>
GRAINLAW_INLINE void forward(const View& f, const Front& front, double* y) {
  const Shape shape(front.pivots, front.others, b);
  const double* const values = f.values + front.values;
  const double* const panel = values + shape.other_panel();
  const std::int32_t* const rows = f.rows + front.rows;
  double* const own = y + front.first * Unknowns::size;
  for (std::size_t k = 0; k < front.pivots; ++k) {
    const auto x = Unknowns::load(own + k * Unknowns::size);
    const typename Unknowns::Spread by = x.spread();
    for (std::size_t r = k + 1; r < front.pivots; ++r) {
      auto to = Unknowns::load(own + r * Unknowns::size);
      to.subtract(values + shape.offset(r, k), shape.pivot_rows, by);
      to.store(own + r * Unknowns::size);
    }
  }
  const auto take = [&]<std::size_t count>(std::size_t k) GRAINLAW_INLINED {
    typename Unknowns::Spread by[count];
#pragma GCC unroll 4
    for (std::size_t i = 0; i < count; ++i) {
      by[i] = Unknowns::load(own + (k + i) * Unknowns::size).spread();
    }
    const double* a = panel + b * k * shape.other_rows;
    for (std::size_t r = 0; r < front.others; ++r, a += b) {
      double* const at = y + static_cast<std::size_t>(rows[r]) * Unknowns::size;
      auto to = Unknowns::load(at);
#pragma GCC unroll 4
      for (std::size_t i = 0; i < count; ++i) {
        to.subtract(a + i * b * shape.other_rows, shape.other_rows, by[i]);
      }
      to.store(at);
    }
  };
  by_pivots<4>(front.pivots, take);
}

template <std::size_t b, class Unknowns>
GRAINLAW_INLINE void backward(const View& f, const Front& front, double* y) {
  const Shape shape(front.pivots, front.others, b);
  const double* const values = f.values + front.values;
  const std::int32_t* const rows = f.rows + front.rows;
  double* const own = y + front.first * Unknowns::size;
  // Two of the others at a time give sums that do not wait for each other.
  const auto give = [&]<std::size_t count>(std::size_t k) GRAINLAW_INLINED {
    Unknowns to[count];
    Unknowns second[count]{};
#pragma GCC unroll 4
    for (std::size_t i = 0; i < count; ++i) to[i] = Unknowns::load(own + (k + i) * Unknowns::size);
    const std::size_t step = b * shape.pivot_rows;
    const double* a = values + shape.offset(k, front.pivots);
    std::size_t r = 0;
    const auto take = [&](Unknowns* sum, const double* at, std::size_t other) GRAINLAW_INLINED {
      const auto x = Unknowns::load(y + static_cast<std::size_t>(rows[other]) * Unknowns::size);
      const typename Unknowns::Spread by = x.spread();
#pragma GCC unroll 4
      for (std::size_t i = 0; i < count; ++i) sum[i].subtract(at + i * b, shape.pivot_rows, by);
    };
    for (; r + 2 <= front.others; r += 2, a += 2 * step) {
      take(to, a, r);
      take(second, a + step, r + 1);
    }
    if (r < front.others) take(to, a, r);
#pragma GCC unroll 4
    for (std::size_t i = 0; i < count; ++i) {
      to[i].add(second[i]);
      to[i].store(own + (k + i) * Unknowns::size);
    }
  };
  if (front.others > 0) by_pivots<Unknowns::backward_pivots>(front.pivots, give);
  for (std::size_t k = front.pivots; k-- > 0;) {
    const auto x = Unknowns::divide(own + k * Unknowns::size, values + shape.offset(k, k),
                                    shape.pivot_rows, f.pivots[front.first + k]);
    x.store(own + k * Unknowns::size);
    const typename Unknowns::Spread found = x.spread();
    for (std::size_t r = 0; r < k; ++r) {
      auto to = Unknowns::load(own + r * Unknowns::size);
      to.subtract(values + shape.offset(r, k), shape.pivot_rows, found);
      to.store(own + r * Unknowns::size);
    }
  }
}

// Substitutes in y, which is in the order of the elimination.
template <std::size_t b, class Unknowns>
GRAINLAW_INLINE void substitute(const View& f, double* y) {
  for (std::size_t k = 0; k < f.fronts.size(); ++k) forward<b, Unknowns>(f, f.fronts[k], y);
  for (std::size_t k = f.fronts.size(); k-- > 0;) backward<b, Unknowns>(f, f.fronts[k], y);
}

GRAINLAW_CLONES void substitute_2(const View& f, double* y) { substitute<2, OneVector<2>>(f, y); }
GRAINLAW_CLONES void substitute_3(const View& f, double* y) { substitute<3, OneVector<3>>(f, y); }
GRAINLAW_CLONES void substitute_6(const View& f, double* y) { substitute<6, OneVector<6>>(f, y); }
GRAINLAW_CLONES void substitute_several_2(const View& f, double* y) {
  substitute<2, Several<2>>(f, y);
}
GRAINLAW_CLONES void substitute_several_3(const View& f, double* y) {
  substitute<3, Several<3>>(f, y);
}
GRAINLAW_CLONES void substitute_several_6(const View& f, double* y) {
  substitute<6, Several<6>>(f, y);
}

}  // namespace

template <std::size_t width>
void BlockLU<width>::solve(std::span<Column> x) {
  const View view = elimination_.view();
  resize_with_capacity(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) work_[j] = x[static_cast<std::size_t>(view.node[j])];
  double* y = work_.data()->lane;
  if constexpr (width == 8) {
    substitute_6(view, y);
  } else {
    components_ == 3 ? substitute_3(view, y) : substitute_2(view, y);
  }
  for (std::size_t j = 0; j < nodes_; ++j) {
    for (std::size_t r = components_; r < width; ++r) work_[j].lane[r] = 0;
    x[static_cast<std::size_t>(view.node[j])] = work_[j];
  }
}

template <std::size_t width>
void BlockLU<width>::solve_together(std::span<Together<width>> x) {
  const View view = elimination_.view();
  const std::size_t b = components_;
  resize_with_capacity(work_together_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&x[static_cast<std::size_t>(view.node[j]) * b], b, &work_together_[j * b]);
  }
  double* y = work_together_.data()->lane;
  if constexpr (width == 8) {
    substitute_several_6(view, y);
  } else {
    components_ == 3 ? substitute_several_3(view, y) : substitute_several_2(view, y);
  }
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&work_together_[j * b], b, &x[static_cast<std::size_t>(view.node[j]) * b]);
  }
}

template void BlockLU<4>::solve(std::span<Column>);
template void BlockLU<8>::solve(std::span<Column>);
template void BlockLU<4>::solve_together(std::span<Together<4>>);
template void BlockLU<8>::solve_together(std::span<Together<8>>);

}  // namespace grainlaw::core
