// Conversion between records of four or eight floats and columns of four, eight or sixteen lanes.
#pragma once

#include "base/simd.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace grainlaw::core::float_loops {

using namespace simd;

template <std::size_t width>
using Floats = Lanes<width, float>;

// Elements of two vectors, a's first, that a shuffle takes for element k. Quarters are of four.
template <std::size_t width>
struct Low {  // pairs from the lower halves of the quarters
  static constexpr std::size_t at(std::size_t k) { return k / 4 * 4 + k % 4 / 2 + k % 2 * width; }
};
template <std::size_t width>
struct High {
  static constexpr std::size_t at(std::size_t k) { return Low<width>::at(k) + 2; }
};
template <std::size_t width>
struct Lower {  // lower halves of the quarters
  static constexpr std::size_t at(std::size_t k) { return k / 4 * 4 + k % 2 + k % 4 / 2 * width; }
};
template <std::size_t width>
struct Upper {
  static constexpr std::size_t at(std::size_t k) { return Lower<width>::at(k) + 2; }
};
template <std::size_t width>
struct Even {  // even quarters, by turns
  static constexpr std::size_t at(std::size_t k) { return k / 8 * 8 + k % 4 + k % 8 / 4 * width; }
};
template <std::size_t width>
struct Odd {
  static constexpr std::size_t at(std::size_t k) { return Even<width>::at(k) + 4; }
};

template <template <std::size_t> class Which, std::size_t width, std::size_t... k>
GRAINLAW_INLINE Floats<width> shuffle(const Floats<width>& a, const Floats<width>& b,
                                      std::index_sequence<k...> /*all*/) {
  return __builtin_shufflevector(a, b, Which<width>::at(k)...);
}
template <template <std::size_t> class Which, std::size_t width>
GRAINLAW_INLINE Floats<width> shuffle(const Floats<width>& a, const Floats<width>& b) {
  return shuffle<Which, width>(a, b, std::make_index_sequence<width>{});
}

// Transposes the quarters of four vectors.
template <std::size_t width>
GRAINLAW_INLINE void transpose(Floats<width>* r) {
  const auto a = shuffle<Low, width>(r[0], r[1]);
  const auto b = shuffle<High, width>(r[0], r[1]);
  const auto c = shuffle<Low, width>(r[2], r[3]);
  const auto d = shuffle<High, width>(r[2], r[3]);
  r[0] = shuffle<Lower, width>(a, c);
  r[1] = shuffle<Upper, width>(a, c);
  r[2] = shuffle<Lower, width>(b, d);
  r[3] = shuffle<Upper, width>(b, d);
}

GRAINLAW_INLINE Floats<16> beside(const Floats<8>& a, const Floats<8>& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

// First six components of the records at these indices, a column each.
template <std::size_t width>
GRAINLAW_INLINE void gather(const float* records, const std::int32_t* index,
                            Floats<width>* column) {
  const auto at = [&](std::size_t k) { return records + 8 * static_cast<std::size_t>(index[k]); };
  if constexpr (width == 4) {
    Floats<4> rest[4];
    for (std::size_t k = 0; k < 4; ++k) {
      column[k] = load<4>(at(k));
      rest[k] = load<4>(at(k) + 4);
    }
    transpose<4>(column);
    transpose<4>(rest);
    column[4] = rest[0];
    column[5] = rest[1];
  } else {
    Floats<width> row[8];
#pragma GCC unroll 8
    for (std::size_t k = 0; k < 8; ++k) {
      if constexpr (width == 8) {
        row[k] = load<8>(at(k));
      } else {
        row[k] = beside(load<8>(at(k)), load<8>(at(k + 8)));
      }
    }
    transpose<width>(row);
    transpose<width>(row + 4);
#pragma GCC unroll 4
    for (std::size_t k = 0; k < 4; ++k) column[k] = shuffle<Even, width>(row[k], row[k + 4]);
    column[4] = shuffle<Odd, width>(row[0], row[4]);
    column[5] = shuffle<Odd, width>(row[1], row[5]);
  }
}

// Records of four at these indices, a column for each component.
template <std::size_t width>
GRAINLAW_INLINE void gather_four(const float* records, const std::int32_t* index,
                                 Floats<width>* column) {
  static_assert(width == 4 || width == 8);
  const auto at = [&](std::size_t k) {
    return load<4>(records + 4 * static_cast<std::size_t>(index[k]));
  };
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
    if constexpr (width == 4) {
      column[k] = at(k);
    } else {
      column[k] = __builtin_shufflevector(at(k), at(k + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    }
  }
  transpose<width>(column);
}

// Stores four columns as consecutive records.
template <std::size_t width>
GRAINLAW_INLINE void scatter_four(const Floats<width>* column, float* records) {
  static_assert(width == 4 || width == 8);
  Floats<width> row[4] = {column[0], column[1], column[2], column[3]};
  transpose<width>(row);
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
    if constexpr (width == 4) {
      store(records + 4 * k, row[k]);
    } else {
      store(records + 4 * k, __builtin_shufflevector(row[k], row[k], 0, 1, 2, 3));
      store(records + 4 * (k + 4), __builtin_shufflevector(row[k], row[k], 4, 5, 6, 7));
    }
  }
}

// Eight elements, from the first or from the ninth on.
template <std::size_t width>
GRAINLAW_INLINE Floats<8> eight(const Floats<width>& a, std::size_t from) {
  if constexpr (width == 8) {
    return a;
  } else {
    return from == 0 ? __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7)
                     : __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
  }
}

// Stores six columns as consecutive records.
template <std::size_t width>
GRAINLAW_INLINE void scatter(const Floats<width>* column, float* records) {
  Floats<width> first[4] = {column[0], column[1], column[2], column[3]};
  Floats<width> rest[4] = {column[4], column[5], Floats<width>{}, Floats<width>{}};
  transpose<width>(first);
  transpose<width>(rest);
  // Quarter q of first[k] and of rest[k] are the halves of record 4 q + k.
#pragma GCC unroll 4
  for (std::size_t k = 0; k < 4; ++k) {
    if constexpr (width == 4) {
      store(records + 8 * k, first[k]);
      store(records + 8 * k + 4, rest[k]);
    } else {
      const auto even = shuffle<Even, width>(first[k], rest[k]);
      const auto odd = shuffle<Odd, width>(first[k], rest[k]);
#pragma GCC unroll 2
      for (std::size_t q = 0; q < width / 8; ++q) {
        store(records + 8 * (8 * q + k), eight<width>(even, q));
        store(records + 8 * (8 * q + 4 + k), eight<width>(odd, q));
      }
    }
  }
}

}  // namespace grainlaw::core::float_loops
