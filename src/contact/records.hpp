// How the loops over contacts see particles and nodes: whole vector registers each.
#pragma once

namespace grainlaw {

template <int D>
struct ParticleRecord;
template <int D>
struct ForceRecord;
template <int D>
struct StiffnessRecord;
template <int D>
struct MassRecord;
template <int D>
struct LeastMass;

// Of a disc. With the turned length R theta for the rotation and M / R for the moment, both ends of a
// contact see the same tangential term.
template <>
struct alignas(32) ParticleRecord<2> {
  double x = 0, y = 0;  // [m]
  double roll = 0;      // R theta [m]
  double radius = 0;    // [m]
};
template <>
struct alignas(32) ForceRecord<2> {
  double x = 0, y = 0;  // [N]
  double roll = 0;      // M / R by tangential forces [N]
  double moment = 0;    // of rolling and bending [N m], until it becomes a part of `roll`
};
// Sums over the contacts that touch.
template <>
struct alignas(32) StiffnessRecord<2> {
  double x = 0, y = 0;  // kn [N/m]
  double roll = 0;      // kt d^2 / (R_i + R_j) [N]
  double bending = 0;   // kr [N m] of laws with moments, else the number of contacts
};
// Pseudo-masses of a relaxation whose steps have length 1: stiffnesses.
template <>
struct alignas(32) MassRecord<2> {
  double x = 0, y = 0;  // [N/m]
  double roll = 0;      // I / R^2 [N/m]
  double filling = 1;
};
// What they are at least, one contact's worth.
template <>
struct alignas(32) LeastMass<2> {
  double x = 0, y = 0, roll = 0;  // [N/m]
  double inverse_radius = 0;      // [1/m]
};

// What acts on i against what acts on j.
template <int D>
inline constexpr ForceRecord<D> opposite{};
template <>
inline constexpr ForceRecord<2> opposite<2>{-1, -1, 1, -1};

}  // namespace grainlaw
