// The candidate contacts of one increment, structure of arrays, with the history they start from.
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

// Contact c joins i[c] and j[c]; its branch is x_j - x_i + cell * shift. Stiffness and committed
// tangential force carry the contact's weight (1 for a cell, 1/copies on a frame). A Hertz-Mindlin
// contact starts from force and moment / overlap^(1/4) (see contact_forces.hpp). The arrays are
// filled up to whole groups of `group` with contacts that never touch.
template <int D>
struct ContactList {
  static constexpr std::size_t group = 8;
  using Column = simd::Column<double>;
  using Columns = std::array<Column, static_cast<std::size_t>(D)>;
  using Springs = std::array<Column, Dimension<D>::tangents>;
  using Spins = std::array<Column, Dimension<D>::spins>;

  std::size_t count = 0;
  simd::Column<std::int32_t> i, j;
  Columns shift;                // lattice counts [-]
  Columns offset;               // cell * shift [m]
  Column reach, inverse_reach;  // R_i + R_j [m], and 1 / it
  Column lever_i;               // lambda_i = R_i / (R_i + R_j) [-]
  Column normal_stiffness;      // kn [N/m]; Hertz: kn / sqrt(overlap) [N/m^1.5]
  Column tangential_stiffness;  // kt [N/m]; Hertz: kt / sqrt(overlap) [N/m^1.5]
  Columns start_normal;         // unit normal at the start of the increment [-]
  Column start_roll;            // of discs: R_i theta_i + R_j theta_j there [m]
  Springs start_force;          // tangential force there [N]; Hertz: see below
  Column weight;                // empty when all are 1 [-]
  // Of laws with bonds, else empty.
  Column hold;  // `held` while bonded, else 0 [N, m]
  Column rest;  // branch without normal force: reach, more when bonded across a gap [m]
  // Of laws with moments, else empty.
  Column bending_stiffness;                   // kr [N m]; Hertz: kr / sqrt(overlap) [N m^0.5]
  Column rolling_length;                      // largest moment / normal force [m]
  Column torsion_stiffness, twisting_length;  // of spheres, the same about the branch
  Column inverse_radius_i, inverse_radius_j;  // [1/m]
  Spins start_spin;                           // theta_j - theta_i there [rad]
  Spins start_moment;                         // moment on j there [N m]; Hertz: below
  std::vector<double> inverse_node_radius;    // [1/m]
  bool turns_far = false;  // a touching branch has turned beyond the short series since the start

  simd::Column<ForceRecord<D>> forces;  // of the last evaluation, on j
  // Of spheres with moments: those on j as x, y, z, and their sums over the contacts of nodes [N m].
  simd::Column<ForceRecord<D>> moments;
  std::vector<ForceRecord<D>> node_moments;
  simd::Column<StiffnessRecord<D>> stiffness;  // of the last sum of stiffnesses; 0 when open
  ContactSums<D> sums;                         // over the contacts of every node

  // Forces, moments and lengths that nothing reaches.
  static constexpr double held = 1e300;

  [[nodiscard]] std::size_t size() const { return count; }
  [[nodiscard]] bool bonded(std::size_t c) const { return !hold.empty() && hold[c] > 0; }
  [[nodiscard]] double rest_of(std::size_t c) const { return rest.empty() ? reach[c] : rest[c]; }
  [[nodiscard]] double weight_of(std::size_t c) const { return weight.empty() ? 1.0 : weight[c]; }
  void resize(std::size_t contacts, bool weighted, double radius, const ContactLaw& law);
};

// Where the history of an increment starts: coordinates (component-major, rotations when the law
// has them), the cell there, and the touching contacts, ordered as the neighbour search orders
// pairs.
template <int D>
struct HistoryStart {
  std::span<const double> coordinates;
  Tensor<D> cell{};
  std::span<const ContactHistory<D>> contacts;
  std::span<const double> moments = {};  // on j, of laws with moments: spins per contact [N m]
  std::span<const double> gaps = {};     // rest - reach, of bonds across gaps: one per contact [m]
};

// Fill the list for a cell from pairs (ordered) and the history (ordered alike). A contact of the
// history that is not among the pairs has opened and is forgotten. pair_weights is empty or holds 1
// or 1/copies; forces are summed over the nodes that the particles belong to.
template <int D>
void build_contacts(std::span<const NeighbourPair<D>> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, std::span<const int> node, std::size_t nodes,
                    const ContactLaw& law, const Tensor<D>& cell, const HistoryStart<D>& start,
                    ContactList<D>& list);

}  // namespace grainlaw::core
