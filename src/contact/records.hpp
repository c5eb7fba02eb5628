// Records of particles and nodes for the loops over contacts: whole vector registers each.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

namespace grainlaw::core {

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

// Record of a disc. With R theta for the rotation and M / R for the moment, both ends of a contact
// have the same tangential term.
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
  double moment = 0;    // of rolling and bending [N m], until added to `roll` over R
};
// Sums over the touching contacts of a node.
template <>
struct alignas(32) StiffnessRecord<2> {
  double x = 0, y = 0;  // kn [N/m]
  double roll = 0;      // kt d^2 / (R_i + R_j) [N]
  double bending = 0;   // kr of laws with moments [N m]; otherwise the number of contacts
};
// Pseudo-masses of a relaxation with unit steps: stiffnesses.
template <>
struct alignas(32) MassRecord<2> {
  double x = 1, y = 1;  // [N/m]
  double roll = 1;      // I / R^2 [N/m]
  double filling = 1;
};
// Lower bounds of the masses: the stiffness of one contact.
template <>
struct alignas(32) LeastMass<2> {
  double x = 0, y = 0, roll = 0;  // [N/m]
  double inverse_radius = 0;      // [1/m]
};

// Record of a sphere. eta = R theta, with the Gibbs vector theta = 2 tan(angle / 2) e of its
// rotation since the start of the history. Its unit quaternion is (2 half, half theta).
template <>
struct alignas(64) ParticleRecord<3> {
  double x = 0, y = 0, z = 0;              // [m]
  double eta_x = 0, eta_y = 0, eta_z = 0;  // [m]
  double half = 0.5;                       // 1 / (2 sqrt(1 + theta^2 / 4)) [-]
  double radius = 0;                       // [m]
};
// Record of forces; with M / R for the moment both ends of a contact have the same term.
template <>
struct alignas(64) ForceRecord<3> {
  double x = 0, y = 0, z = 0;                 // [N]
  double spin_x = 0, spin_y = 0, spin_z = 0;  // M / R [N]
  double filling[2] = {};
};
template <>
struct alignas(64) StiffnessRecord<3> {
  double x = 0, y = 0, z = 0;                 // kn [N/m]
  double spin_x = 0, spin_y = 0, spin_z = 0;  // kt d^2 / (R_i + R_j) [N]
  double bending = 0;                         // for laws with moments [N m]
  double filling = 0;
};
template <>
struct alignas(64) MassRecord<3> {
  double x = 1, y = 1, z = 1;                 // [N/m]
  double spin_x = 1, spin_y = 1, spin_z = 1;  // I / R^2 [N/m]
  double filling[2] = {1, 1};
};
template <>
struct LeastMass<3> {
  double x = 0;               // in every direction [N/m]
  double spin = 0;            // [N/m]
  double inverse_radius = 0;  // [1/m]
};

// The components of a record: translations, then rotations.
template <class Record>
inline constexpr auto components_of = [] {
  if constexpr (requires(Record record) { record.eta_x; }) {
    return std::array{&Record::x,     &Record::y,     &Record::z,
                      &Record::eta_x, &Record::eta_y, &Record::eta_z};
  } else if constexpr (requires(Record record) { record.spin_x; }) {
    return std::array{&Record::x,      &Record::y,      &Record::z,
                      &Record::spin_x, &Record::spin_y, &Record::spin_z};
  } else {
    return std::array{&Record::x, &Record::y, &Record::roll};
  }
}();
template <class Record>
constexpr auto& component(Record& record, std::size_t k) {
  return record.*components_of<std::remove_const_t<Record>>[k];
}

// Drag on nodes: stiffness x (expected - position) each; empty without drag.
template <int D>
struct NodeDrag {
  std::span<const ParticleRecord<D>> expected;
  std::span<const MassRecord<D>> stiffness;  // 0 in padding
};

// Factors from the record on j to that on i.
template <int D>
inline constexpr ForceRecord<D> opposite{};
template <>
inline constexpr ForceRecord<2> opposite<2>{-1, -1, 1, -1};
template <>
inline constexpr ForceRecord<3> opposite<3>{-1, -1, -1, 1, 1, 1, {}};

}  // namespace grainlaw::core
