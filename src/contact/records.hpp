// How contact loops see particles: one vector register each.
#pragma once

namespace grainlaw {

// With the turned length R theta for the rotation and M / R for the moment, both ends of a contact
// see the same tangential term.
struct alignas(32) ParticleRecord {
  double x = 0, y = 0;  // [m]
  double roll = 0;      // R theta [m]
  double radius = 0;    // [m]
};
struct alignas(32) ForceRecord {
  double x = 0, y = 0;  // [N]
  double roll = 0;      // M / R [N]
  double unused = 0;
};

// What acts on i against what acts on j; the last of the moment of rolling and bending.
inline constexpr ForceRecord opposite{-1, -1, 1, -1};

}  // namespace grainlaw
