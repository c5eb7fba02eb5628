// Conversion between records of spheres or their contacts and columns of lanes.
#pragma once

#include "contact/disc_columns.hpp"

namespace grainlaw::core::sphere_loops {

using namespace simd;
using disc_loops::GroupSum;

// Vectors with a component per register.
template <std::size_t width, class Real = double>
struct Triple {
  Lanes<width, Real> x, y, z;
};

template <std::size_t width, class Real>
GRAINLAW_INLINE Lanes<width, Real> dot(const Triple<width, Real>& a, const Triple<width, Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <std::size_t width, class Real>
GRAINLAW_INLINE Triple<width, Real> cross(const Triple<width, Real>& a,
                                          const Triple<width, Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <std::size_t width, class Real>
GRAINLAW_INLINE Triple<width, Real> sum(const Triple<width, Real>& a,
                                        const Triple<width, Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
// Computes a + factor b.
template <std::size_t width, class Real>
GRAINLAW_INLINE Triple<width, Real> sum(const Triple<width, Real>& a,
                                        const std::type_identity_t<Lanes<width, Real>>& factor,
                                        const Triple<width, Real>& b) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
template <std::size_t width, class Real>
GRAINLAW_INLINE Triple<width, Real> product(const std::type_identity_t<Lanes<width, Real>>& factor,
                                            const Triple<width, Real>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}

template <std::size_t width>
struct Spheres {
  Triple<width> position, eta;
  Lanes<width> half, radius;
};

// Records at these indices.
template <std::size_t width>
GRAINLAW_INLINE Spheres<width> spheres_at(const double* records, const std::int32_t* index) {
  const auto first = disc_loops::records_of<width, 8>(records, index);
  const auto second = disc_loops::records_of<width, 8>(records + 4, index);
  return {
      {first.x, first.y, first.roll}, {first.last, second.x, second.y}, second.roll, second.last};
}

template <std::size_t width>
GRAINLAW_INLINE Triple<width> triple_at(const std::array<Column<double>, 3>& columns,
                                        std::size_t c) {
  return {load<width>(&columns[0][c]), load<width>(&columns[1][c]), load<width>(&columns[2][c])};
}
template <std::size_t width>
GRAINLAW_INLINE void put(const Triple<width>& value, std::array<Column<double>, 3>& columns,
                         std::size_t c) {
  store(&columns[0][c], value.x);
  store(&columns[1][c], value.y);
  store(&columns[2][c], value.z);
}

// Stores two vectors and a number as a record of each contact.
template <std::size_t width>
GRAINLAW_INLINE void put_records(const Triple<width>& a, const Triple<width>& b, double* to,
                                 const Lanes<width>& last = Lanes<width>{}) {
  const Lanes<width> zero{};
  disc_loops::put_records<width>({a.x, a.y, a.z, b.x}, [to](std::size_t k) { return to + 8 * k; });
  disc_loops::put_records<width>({b.y, b.z, last, zero},
                                 [to](std::size_t k) { return to + 8 * k + 4; });
}

}  // namespace grainlaw::core::sphere_loops
