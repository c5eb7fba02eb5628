// Conversion between records of particles or contacts and columns of lanes, and sums that do not
// depend on the number of lanes.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_list.hpp"

#include <cstddef>
#include <cstdint>

namespace grainlaw::core::disc_loops {

using namespace simd;

static_assert(sizeof(ParticleRecord<2>) == sizeof(Record) &&
              sizeof(ForceRecord<2>) == sizeof(Record));

// Records of contacts or pairs of particles, one per lane.
template <std::size_t width>
struct Columns {
  Lanes<width> x, y, roll, last;
};

// Record of the particle at a lane and, with eight lanes, of the one four further on.
template <std::size_t width, std::size_t stride = 4>
GRAINLAW_INLINE Lanes<width> record(const double* records, const std::int32_t* index,
                                    std::size_t lane) {
  const auto at = [&](std::size_t k) {
    return load<4>(records + stride * static_cast<std::size_t>(index[k]));
  };
  if constexpr (width == 4) {
    return at(lane);
  } else {
    return beside(at(lane), at(lane + 4));
  }
}

// Half of a record: x and y, or the rest.
template <std::size_t stride = 4>
GRAINLAW_INLINE Lanes<2> half_record(const double* records, std::int32_t index, std::size_t from) {
  return load<2>(records + stride * static_cast<std::size_t>(index) + from);
}

// Records at these indices, `stride` doubles apart.
template <std::size_t width, std::size_t stride = 4>
GRAINLAW_INLINE Columns<width> records_of(const double* records, const std::int32_t* index) {
  if constexpr (width == 2) {
    Lanes<2> x = half_record<stride>(records, index[0], 0);
    Lanes<2> y = half_record<stride>(records, index[1], 0);
    Lanes<2> roll = half_record<stride>(records, index[0], 2);
    Lanes<2> last = half_record<stride>(records, index[1], 2);
    transpose(x, y);
    transpose(roll, last);
    return {x, y, roll, last};
  } else {
    auto a = record<width, stride>(records, index, 0);
    auto b = record<width, stride>(records, index, 1);
    auto c = record<width, stride>(records, index, 2);
    auto d = record<width, stride>(records, index, 3);
    transpose(a, b, c, d);
    return {a, b, c, d};
  }
}

// Consecutive records.
template <std::size_t width>
GRAINLAW_INLINE Columns<width> columns_at(const double* records) {
  constexpr std::int32_t index[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  return records_of<width>(records, index);
}

// Columns p_j + sign p_i = (l_x, l_y, rolls, radii) of the pairs i, j of particles.
template <std::size_t width>
GRAINLAW_INLINE Columns<width> pair_columns(const double* particles, const std::int32_t* i,
                                            const std::int32_t* j) {
  if constexpr (width == 2) {
    Lanes<2> x = half_record(particles, j[0], 0) - half_record(particles, i[0], 0);
    Lanes<2> y = half_record(particles, j[1], 0) - half_record(particles, i[1], 0);
    Lanes<2> roll = half_record(particles, j[0], 2) + half_record(particles, i[0], 2);
    Lanes<2> radii = half_record(particles, j[1], 2) + half_record(particles, i[1], 2);
    transpose(x, y);
    transpose(roll, radii);
    return {x, y, roll, radii};
  } else {
    using V = Lanes<width>;
    V sign;  // flipped, not multiplied by
    for (std::size_t k = 0; k < width; ++k) sign[k] = k % 4 < 2 ? -0.0 : 0.0;
    V a = record<width>(particles, j, 0) + flip(record<width>(particles, i, 0), sign);
    V b = record<width>(particles, j, 1) + flip(record<width>(particles, i, 1), sign);
    V c = record<width>(particles, j, 2) + flip(record<width>(particles, i, 2), sign);
    V d = record<width>(particles, j, 3) + flip(record<width>(particles, i, 3), sign);
    transpose(a, b, c, d);
    return {a, b, c, d};
  }
}

// Stores columns as records; place(k) is the address for lane k.
template <std::size_t width, class Address>
GRAINLAW_INLINE void put_records(const Columns<width>& columns, Address&& address) {
  Columns<width> from = columns;
  if constexpr (width == 2) {
    transpose(from.x, from.y);
    transpose(from.roll, from.last);
    store(address(0), from.x);
    store(address(0) + 2, from.roll);
    store(address(1), from.y);
    store(address(1) + 2, from.last);
  } else {
    transpose(from.x, from.y, from.roll, from.last);
    const auto put = [&](std::size_t k, const Lanes<width>& row) {
      if constexpr (width == 4) {
        store(address(k), row);
      } else {
        store(address(k), first(row));
        store(address(k + 4), second(row));
      }
    };
    put(0, from.x);
    put(1, from.y);
    put(2, from.roll);
    put(3, from.last);
  }
}
template <std::size_t width>
GRAINLAW_INLINE void put_records(const Columns<width>& from, double* to) {
  put_records<width>(from, [to](std::size_t k) { return to + 4 * k; });
}

// Sum over contacts by their positions in a group, with equal bits for any width.
template <std::size_t width, class Real = double>
struct GroupSum {
  static constexpr std::size_t parts =
      ContactList<2>::group * sizeof(double) / sizeof(Real) / width;
  Lanes<width, Real> part[parts] = {};

  GRAINLAW_INLINE void add(std::size_t c, const Lanes<width, Real>& value) {
    part[c / width % parts] += value;
  }
  GRAINLAW_INLINE double total() const {
    double sum = 0;
    for (const auto& lanes : part) {
      for (std::size_t k = 0; k < width; ++k) sum += lanes[k];
    }
    return sum;
  }
};

}  // namespace grainlaw::core::disc_loops
