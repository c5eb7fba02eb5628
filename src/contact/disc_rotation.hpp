// Rotation angle of a branch without trigonometric calls, for doubles and vectors of them.
#pragma once

#include "base/simd.hpp"

namespace grainlaw::core {

// Sine up to which the series of an angle is exact to rounding: 11 degrees. Touching contacts
// rarely rotate further in an increment of a host.
constexpr double short_series = 0.2;

// Arc sine of s by its series, exact to rounding for |s| <= 0.2. Even and odd powers are separate,
// because one long chain of multiplications would limit the whole loop.
template <class Vector>
GRAINLAW_INLINE Vector arc_sine(const Vector& s) {
  const Vector u = s * s;
  const Vector u2 = u * u;
  const Vector u4 = u2 * u2;
  const Vector even =
      (1.0 + u2 * (3.0 / 40)) + u4 * ((35.0 / 1152 + u2 * (231.0 / 13312)) +
                                      u4 * (6435.0 / 557056 + u2 * (46189.0 / 5505024)));
  const Vector odd = (1.0 / 6 + u2 * (5.0 / 112)) +
                     u4 * ((63.0 / 2816 + u2 * (143.0 / 10240)) + u4 * (12155.0 / 1245184));
  return s * (even + u * odd);
}

// Arc tangent of t by its series, exact to rounding for |t| <= 0.2.
template <class Vector>
GRAINLAW_INLINE Vector arc_tangent(const Vector& t) {
  const Vector u = t * t;
  const Vector u2 = u * u;
  const Vector u4 = u2 * u2;
  const Vector a = (1.0 - u * (1.0 / 3)) + u2 * (1.0 / 5 - u * (1.0 / 7));
  const Vector b = (1.0 / 9 - u * (1.0 / 11)) + u2 * (1.0 / 13 - u * (1.0 / 15));
  const Vector c = (1.0 / 17 - u * (1.0 / 19)) + u2 * (1.0 / 21);
  return t * (a + u4 * (b + u4 * c));
}

// Any rotation by halving the angle, exact to rounding below 90 degrees and to 1e-7 at 180. dot and
// cross are products of start normal and branch.
template <class Vector>
GRAINLAW_INLINE Vector far_angle(const Vector& distance, const Vector& dot, const Vector& cross) {
  const Vector half = cross / simd::largest(distance + dot, 1e-12 * distance);
  const Vector quarter = half / (1 + simd::square_root(1 + half * half));
  return 8 * arc_tangent(quarter / (1 + simd::square_root(1 + quarter * quarter)));
}

}  // namespace grainlaw::core
