// The solves: forward and backward substitution, front by front.
#include "linear/block_lu_view.hpp"
#include "linear/quad.hpp"

#include "base/room.hpp"

#include <algorithm>

namespace grainlaw {

using namespace quad;
using dense::Pivot;
using dense::Shape;

namespace {

using View = BlockLU::View;
using Front = BlockLU::Front;

// A node's unknowns: of one vector, in the lanes; what the last lane holds is never read.
template <std::size_t b>
struct OneVector {
  static constexpr std::size_t size = width;
  static constexpr std::size_t backward_pivots = 4;  // at once: sixteen registers hold their sums
  Lanes value;

  struct Spread {
    double by[b];
  };
  GRAINLAW_INLINE static OneVector load(const double* from) { return {quad::load(from)}; }
  GRAINLAW_INLINE void store(double* to) const { quad::store(to, value); }
  GRAINLAW_INLINE Spread spread() const {
    Spread result;
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) result.by[c] = value[c];
    return result;
  }
  GRAINLAW_INLINE void add(const OneVector& other) { value += other.value; }
  // -= a x and = a x; a is a block by columns, `stride` apart.
  GRAINLAW_INLINE void subtract(const double* a, std::size_t stride, const Spread& x) {
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) value -= quad::load(a + c * stride) * x.by[c];
  }
  // The entries of a^-1 x, of a pivot; x lies at `from`.
  GRAINLAW_INLINE static OneVector divide(const double* from, const double* a, std::size_t stride,
                                          const Pivot& pivot) {
    OneVector result{};
    if (!pivot.triangular) {
      result.value = quad::load(a) * from[0];
#pragma GCC unroll 3
      for (std::size_t c = 1; c < b; ++c) result.value += quad::load(a + c * stride) * from[c];
      return result;
    }
    double x[b];
    dense::divide_column<b>(x, a, stride, pivot, [&](std::size_t c) { return from[c]; });
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) result.value[c] = x[c];
    return result;
  }
};

// Of four vectors, one in every lane, a register for every unknown.
template <std::size_t b>
struct FourVectors {
  static constexpr std::size_t size = b * width;
  static constexpr std::size_t backward_pivots = 2;
  using Spread = FourVectors;
  Lanes value[b];

  GRAINLAW_INLINE static FourVectors load(const double* from) {
    FourVectors result;
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) result.value[c] = quad::load(from + c * width);
    return result;
  }
  GRAINLAW_INLINE void store(double* to) const {
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) quad::store(to + c * width, value[c]);
  }
  GRAINLAW_INLINE const Spread& spread() const { return *this; }
  GRAINLAW_INLINE void add(const FourVectors& other) {
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) value[c] += other.value[c];
  }
  GRAINLAW_INLINE void subtract(const double* a, std::size_t stride, const Spread& x) {
#pragma GCC unroll 3
    for (std::size_t c = 0; c < b; ++c) {
#pragma GCC unroll 3
      for (std::size_t r = 0; r < b; ++r) value[r] -= a[c * stride + r] * x.value[c];
    }
  }
  GRAINLAW_INLINE static FourVectors divide(const double* from, const double* a, std::size_t stride,
                                            const Pivot& pivot) {
    FourVectors result;
    const auto take = [&](std::size_t c) GRAINLAW_INLINED { return quad::load(from + c * width); };
    if (pivot.triangular) {
      dense::divide_column<b>(result.value, a, stride, pivot, take);
      return result;
    }
#pragma GCC unroll 3
    for (std::size_t r = 0; r < b; ++r) {
      result.value[r] = a[r] * take(0);
#pragma GCC unroll 3
      for (std::size_t c = 1; c < b; ++c) result.value[r] += a[c * stride + r] * take(c);
    }
    return result;
  }
};

// Visits as many pivots at a time as may be, at most four or two.
template <std::size_t most, class Visit>
GRAINLAW_INLINE void by_pivots(std::size_t pivots, const Visit& visit) {
  std::size_t k = 0;
  if constexpr (most == 4) {
    for (; k + 4 <= pivots; k += 4) visit.template operator()<4>(k);
  }
  for (; k + 2 <= pivots; k += 2) visit.template operator()<2>(k);
  if (k < pivots) visit.template operator()<1>(k);
}

// The front's pivots, and from them what they take from the others.
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
      to.subtract(values + shape.place(r, k), shape.pivot_rows, by);
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
  // From two of the others at a time: sums that do not wait for each other.
  const auto give = [&]<std::size_t count>(std::size_t k) GRAINLAW_INLINED {
    Unknowns to[count];
    Unknowns second[count]{};
#pragma GCC unroll 4
    for (std::size_t i = 0; i < count; ++i) to[i] = Unknowns::load(own + (k + i) * Unknowns::size);
    const std::size_t step = b * shape.pivot_rows;
    const double* a = values + shape.place(k, front.pivots);
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
    const auto x = Unknowns::divide(own + k * Unknowns::size, values + shape.place(k, k),
                                    shape.pivot_rows, f.pivots[front.first + k]);
    x.store(own + k * Unknowns::size);
    const typename Unknowns::Spread found = x.spread();
    for (std::size_t r = 0; r < k; ++r) {
      auto to = Unknowns::load(own + r * Unknowns::size);
      to.subtract(values + shape.place(r, k), shape.pivot_rows, found);
      to.store(own + r * Unknowns::size);
    }
  }
}

// y in the elimination's order.
template <std::size_t b, class Unknowns>
GRAINLAW_INLINE void substitute(const View& f, double* y) {
  for (std::size_t k = 0; k < f.fronts.size(); ++k) forward<b, Unknowns>(f, f.fronts[k], y);
  for (std::size_t k = f.fronts.size(); k-- > 0;) backward<b, Unknowns>(f, f.fronts[k], y);
}

GRAINLAW_CLONES void substitute_3(const View& f, double* y) { substitute<3, OneVector<3>>(f, y); }
GRAINLAW_CLONES void substitute_2(const View& f, double* y) { substitute<2, OneVector<2>>(f, y); }
GRAINLAW_CLONES void substitute_four_3(const View& f, double* y) {
  substitute<3, FourVectors<3>>(f, y);
}
GRAINLAW_CLONES void substitute_four_2(const View& f, double* y) {
  substitute<2, FourVectors<2>>(f, y);
}

}  // namespace

void BlockLU::solve(std::span<Quad> x) {
  resize_with_room(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) work_[j] = x[static_cast<std::size_t>(node_[j])];
  double* y = work_.data()->lane;
  components_ == 3 ? substitute_3(view(), y) : substitute_2(view(), y);
  for (std::size_t j = 0; j < nodes_; ++j) {
    work_[j].lane[3] = 0;
    x[static_cast<std::size_t>(node_[j])] = work_[j];
  }
}

void BlockLU::solve_four(std::span<Quad> x) {
  const auto b = static_cast<std::size_t>(components_);
  resize_with_room(work_, x.size());
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&x[static_cast<std::size_t>(node_[j]) * b], b, &work_[j * b]);
  }
  double* y = work_.data()->lane;
  components_ == 3 ? substitute_four_3(view(), y) : substitute_four_2(view(), y);
  for (std::size_t j = 0; j < nodes_; ++j) {
    std::copy_n(&work_[j * b], b, &x[static_cast<std::size_t>(node_[j]) * b]);
  }
}

}  // namespace grainlaw
