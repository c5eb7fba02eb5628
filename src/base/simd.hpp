// Vector registers of two, four or eight doubles, or twice as many floats, by the compiler's vector
// types. Functions are
// compiled once per instruction set, and the best one is chosen when the program starts.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <type_traits>
#include <vector>

// All functions that pass vectors by value are inlined, so the ABI warning is void.
#pragma GCC diagnostic ignored "-Wpsabi"

// Widest registers to dispatch to [bit]. Sums of different widths differ by rounding.
#ifndef GRAINLAW_WIDEST_VECTORS
#define GRAINLAW_WIDEST_VECTORS 512
#endif
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GRAINLAW_DISPATCH GRAINLAW_WIDEST_VECTORS
#else
#define GRAINLAW_DISPATCH 128
#endif

#if GRAINLAW_DISPATCH >= 512
#define GRAINLAW_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#define GRAINLAW_OF_EIGHT __attribute__((target("arch=x86-64-v4")))
#define GRAINLAW_OF_FOUR __attribute__((target("arch=x86-64-v3")))
#elif GRAINLAW_DISPATCH >= 256
#define GRAINLAW_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#define GRAINLAW_OF_EIGHT
#define GRAINLAW_OF_FOUR __attribute__((target("arch=x86-64-v3")))
#else
#define GRAINLAW_CLONES
#define GRAINLAW_OF_EIGHT
#define GRAINLAW_OF_FOUR
#endif
#define GRAINLAW_INLINE inline __attribute__((always_inline))
#define GRAINLAW_INLINED __attribute__((always_inline))  // for lambdas

namespace grainlaw::core::simd {

// Limit of lanes from the environment variable GRAINLAW_LANES, for tests. Results keep their bits.
inline const int most_lanes = [] {
  const char* const asked = std::getenv("GRAINLAW_LANES");
  return asked == nullptr ? 8 : std::atoi(asked);
}();

inline bool eight_lanes() {
#if GRAINLAW_DISPATCH >= 512
  return most_lanes >= 8 && __builtin_cpu_supports("x86-64-v4") != 0;
#else
  return false;
#endif
}

inline bool four_lanes() {
#if GRAINLAW_DISPATCH >= 256
  return most_lanes >= 4 && __builtin_cpu_supports("x86-64-v3") != 0;
#elif defined(__AVX2__)
  return true;
#else
  return false;
#endif
}

// Defines function(parameters) as a dispatch to of<lanes, ...>(arguments) by the lanes of the
// processor.
#define GRAINLAW_BY_LANES(Result, function, of, parameters, arguments, ...)                  \
  Result function##_of_two parameters { return of<2 __VA_OPT__(, ) __VA_ARGS__> arguments; } \
  GRAINLAW_OF_FOUR Result function##_of_four parameters {                                    \
    return of<4 __VA_OPT__(, ) __VA_ARGS__> arguments;                                       \
  }                                                                                          \
  GRAINLAW_OF_EIGHT Result function##_of_eight parameters {                                  \
    return of<8 __VA_OPT__(, ) __VA_ARGS__> arguments;                                       \
  }                                                                                          \
  Result function parameters {                                                               \
    if (simd::eight_lanes()) return function##_of_eight arguments;                           \
    return simd::four_lanes() ? function##_of_four arguments : function##_of_two arguments;  \
  }

template <std::size_t width, class Real = double>
struct Vector {
  using Integer = std::conditional_t<sizeof(Real) == 4, int, long long>;
  typedef Real type __attribute__((vector_size(width * sizeof(Real))));
  typedef Integer bits __attribute__((vector_size(width * sizeof(Real))));
};
template <std::size_t width, class Real = double>
using Lanes = typename Vector<width, Real>::type;
using Record = Lanes<4>;
template <class Vector>
using Element = std::remove_cvref_t<decltype(Vector{}[0])>;
template <class Vector>
inline constexpr std::size_t width_of = sizeof(Vector) / sizeof(Element<Vector>);

template <std::size_t width, class Real>
GRAINLAW_INLINE Lanes<width, Real> load(const Real* from) {
  Lanes<width, Real> value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
template <class Vector>
GRAINLAW_INLINE void store(Element<Vector>* to, const Vector& value) {
  std::memcpy(to, &value, sizeof value);
}

// Concatenates two records of four.
GRAINLAW_INLINE Lanes<8> beside(const Record& a, const Record& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
GRAINLAW_INLINE Record first(const Lanes<8>& a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3);
}
GRAINLAW_INLINE Record second(const Lanes<8>& a) {
  return __builtin_shufflevector(a, a, 4, 5, 6, 7);
}

// Transposes records, one per row, into columns, and back. Two lanes take half a record per row,
// eight lanes two.
GRAINLAW_INLINE void transpose(Lanes<2>& a, Lanes<2>& b) {
  const Lanes<2> odd = __builtin_shufflevector(a, b, 1, 3);
  a = __builtin_shufflevector(a, b, 0, 2);
  b = odd;
}
GRAINLAW_INLINE void transpose(Lanes<4>& a, Lanes<4>& b, Lanes<4>& c, Lanes<4>& d) {
  const Lanes<4> ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Lanes<4> ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lanes<4> cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes<4> cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}
GRAINLAW_INLINE void transpose(Lanes<8>& a, Lanes<8>& b, Lanes<8>& c, Lanes<8>& d) {
  const Lanes<8> ab_even = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes<8> ab_odd = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes<8> cd_even = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
  const Lanes<8> cd_odd = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 8, 9, 4, 5, 12, 13);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 10, 11, 6, 7, 14, 15);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 10, 11, 6, 7, 14, 15);
}

template <class Vector>
GRAINLAW_INLINE Vector square_root(const Vector& a) {
  Vector root;
#pragma GCC unroll 16
  for (std::size_t k = 0; k < width_of<Vector>; ++k) {
    if constexpr (sizeof a[0] == sizeof(float)) {
      root[k] = __builtin_sqrtf(a[k]);
    } else {
      root[k] = __builtin_sqrt(a[k]);
    }
  }
  return root;
}
template <class Vector>
GRAINLAW_INLINE Vector largest(const Vector& a, const Vector& b) {
  return a > b ? a : b;
}
template <class Vector>
GRAINLAW_INLINE Vector smallest(const Vector& a, const Vector& b) {
  return a < b ? a : b;
}
template <class Vector>
GRAINLAW_INLINE Vector magnitude(const Vector& a) {
  using Of = simd::Vector<width_of<Vector>, Element<Vector>>;
  constexpr auto all_but_sign = std::numeric_limits<typename Of::Integer>::max();
  return (Vector)((typename Of::bits)a & all_but_sign);
}
// Changes the sign of the components where `sign` is -0.
template <class Vector>
GRAINLAW_INLINE Vector flip(const Vector& a, const Vector& sign) {
  using Bits = typename simd::Vector<width_of<Vector>, Element<Vector>>::bits;
  return (Vector)((Bits)a ^ (Bits)sign);
}
template <class Vector>
GRAINLAW_INLINE double sum(const Vector& a) {
  double total = 0;
  for (std::size_t k = 0; k < width_of<Vector>; ++k) total += a[k];
  return total;
}
template <class Vector>
GRAINLAW_INLINE double most(const Vector& a) {
  double value = a[0];
  for (std::size_t k = 1; k < width_of<Vector>; ++k) value = a[k] > value ? a[k] : value;
  return value;
}

// Allocator with an alignment of 64 bytes, so that no register lies across two cache lines.
template <class Value>
struct CacheLineAllocator {
  using value_type = Value;
  static constexpr std::align_val_t alignment{64};

  CacheLineAllocator() = default;
  template <class Other>
  CacheLineAllocator(const CacheLineAllocator<Other>& /*other*/) {}
  Value* allocate(std::size_t count) {
    return static_cast<Value*>(::operator new(count * sizeof(Value), alignment));
  }
  void deallocate(Value* memory, std::size_t /*count*/) { ::operator delete(memory, alignment); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};
template <class Value>
using Column = std::vector<Value, CacheLineAllocator<Value>>;

}  // namespace grainlaw::core::simd
