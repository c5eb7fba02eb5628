// List of the candidate contacts of one increment, as structure of arrays, with the start of their
// history.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_sums.hpp"
#include "contact/history.hpp"
#include "contact/law.hpp"
#include "math/tensor.hpp"
#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Contact c joins i[c] and j[c] by the branch x_j - x_i + cell * shift. @formula branch Stiffness
// and committed tangential force include the contact's weight (1 for a cell, 1/copies on a frame).
// A Hertz-Mindlin contact starts from force and moment / overlap^(1/4); see contact_forces.hpp.
// Arrays are padded to whole groups of `group` with contacts that never touch.
template <int D>
struct ContactList {
  static constexpr std::size_t group = 8;
  using Column = simd::Column<double>;
  using Columns = std::array<Column, static_cast<std::size_t>(D)>;
  using Springs = std::array<Column, Dimension<D>::tangents>;
  using Spins = std::array<Column, Dimension<D>::spins>;

  std::size_t count = 0;
  simd::Column<std::int32_t> i, j;
  Columns shift;                // cell counts [-]
  Columns offset;               // cell * shift [m]
  Column reach, inverse_reach;  // R_i + R_j [m], and 1 / it
  Column lever_i;               // lambda_i = R_i / (R_i + R_j) [-]
  Column normal_stiffness;      // kn [N/m]; Hertz: kn / sqrt(overlap) [N/m^1.5]
  Column tangential_stiffness;  // kt [N/m]; Hertz: kt / sqrt(overlap) [N/m^1.5]
  Columns start_normal;         // unit normal at the start of the increment [-]
  Column start_roll;            // for discs: R_i theta_i + R_j theta_j there [m]
  Springs start_force;          // tangential force there [N]; Hertz: force / overlap^(1/4)
  Column weight;                // empty when all are 1 [-]
  // Columns of laws with bonds, otherwise empty.
  Column bond_capacity;  // `held` while bonded, else 0 [N, m]
  Column rest;           // branch without normal force: reach, or more for a bond across a gap [m]
  // Columns of laws with moments, otherwise empty.
  Column bending_stiffness;                   // kr [N m]; Hertz: kr / sqrt(overlap) [N m^0.5]
  Column rolling_length;                      // largest moment / normal force [m]
  Column torsion_stiffness, twisting_length;  // for spheres, about the branch
  Column inverse_radius_i, inverse_radius_j;  // [1/m]
  Spins start_spin;                           // theta_j - theta_i there [rad]
  Spins start_moment;  // moment on j there [N m]; Hertz: moment / overlap^(1/4)
  std::vector<double> inverse_node_radius;  // [1/m]
  bool rotates_far = false;  // a touching branch rotated beyond the short series since the start

  simd::Column<ForceRecord<D>> forces;  // of the last evaluation, on j
  // Moments of spheres on j as x, y, z, and their sums over the contacts of nodes [N m].
  simd::Column<ForceRecord<D>> moments;
  std::vector<ForceRecord<D>> node_moments;
  simd::Column<StiffnessRecord<D>> stiffness;  // of the last sum of stiffnesses; 0 when open
  ContactSums<D> sums;                         // over the contacts of every node

  // Bond capacity: a force, moment or length that nothing reaches [N, N m, m].
  static constexpr double unbreakable = 1e300;

  [[nodiscard]] std::size_t size() const { return count; }
  [[nodiscard]] bool bonded(std::size_t c) const {
    return !bond_capacity.empty() && bond_capacity[c] > 0;
  }
  [[nodiscard]] double rest_of(std::size_t c) const { return rest.empty() ? reach[c] : rest[c]; }
  [[nodiscard]] double weight_of(std::size_t c) const { return weight.empty() ? 1.0 : weight[c]; }
  void resize(std::size_t contacts, bool weighted, double radius, const ContactLaw& law);
};

// Start of the history of an increment: coordinates (component-major, with rotations if the law has
// them), cell, and touching contacts in the order of the neighbour search.
template <int D>
struct HistoryStart {
  std::span<const double> coordinates;
  Tensor<D> cell{};
  std::span<const ContactHistory<D>> contacts;
  std::span<const double> moments = {};  // on j, for laws with moments: `spins` per contact [N m]
  std::span<const double> gaps = {};     // rest - reach, for bonds across gaps: one per contact [m]
};

// Fills the list for a cell from pairs and history, both in the same order. Contacts of the history
// that are not among the pairs have opened and are dropped. pair_weights is empty or holds 1 or
// 1/copies. Forces are summed over the nodes that the particles belong to.
template <int D>
void build_contacts(std::span<const NeighbourPair<D>> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, std::span<const int> node, std::size_t nodes,
                    const ContactLaw& law, const Tensor<D>& cell, const HistoryStart<D>& start,
                    ContactList<D>& list);

}  // namespace grainlaw::core
