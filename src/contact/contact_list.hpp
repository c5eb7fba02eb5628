// The candidate contacts of one increment, structure of arrays, with the history they start from.
#pragma once

#include "base/simd.hpp"
#include "contact/contact_sums.hpp"
#include "contact/history.hpp"
#include "contact/law.hpp"
#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw {

// Contact c joins i[c] and j[c]; its branch is x_j - x_i + cell * shift. Stiffness and committed
// tangential force carry the contact's weight (1 for a cell, 1/copies on a frame). A Hertz-Mindlin
// contact starts from force and moment / overlap^(1/4) (see frictional.hpp). The arrays are
// filled up to whole groups of `group` with contacts that never touch.
struct ContactList {
  static constexpr std::size_t group = 8;

  std::size_t count = 0;
  simd::Column<std::int32_t> i, j;
  simd::Column<double> shift_x, shift_y;      // lattice counts [-]
  simd::Column<double> offset_x, offset_y;    // cell * shift [m]
  simd::Column<double> reach, inverse_reach;  // R_i + R_j [m], and 1 / it
  simd::Column<double> lever_i;               // lambda_i = R_i / (R_i + R_j) [-]
  simd::Column<double> normal_stiffness;      // kn [N/m]; Hertz: kn / sqrt(overlap) [N/m^1.5]
  simd::Column<double> tangential_stiffness;  // kt [N/m]; Hertz: kt / sqrt(overlap) [N/m^1.5]
  simd::Column<double> start_x, start_y;      // unit normal at the start of the increment [-]
  simd::Column<double> start_roll;            // R_i theta_i + R_j theta_j there [m]
  simd::Column<double> start_force;           // tangential force there [N]; Hertz: see below
  simd::Column<double> weight;                // empty when all are 1 [-]
  // Of laws with bonds, else empty.
  simd::Column<double> hold;  // `held` while bonded, else 0 [N, m]
  simd::Column<double>
      rest;  // branch without normal force: reach, more when bonded across a gap [m]
  // Of laws with moments, else empty.
  simd::Column<double> bending_stiffness;  // kr [N m]; Hertz: kr / sqrt(overlap) [N m^0.5]
  simd::Column<double> rolling_length;     // largest moment / normal force [m]
  simd::Column<double> inverse_radius_i, inverse_radius_j;  // [1/m]
  simd::Column<double> start_spin;                          // theta_j - theta_i there [rad]
  simd::Column<double> start_moment;                        // moment on j there [N m]; Hertz: below
  std::vector<double> inverse_node_radius;                  // [1/m]
  bool turns_far = false;  // a touching branch has turned beyond the short series since the start

  simd::Column<ForceRecord> forces;  // of the last evaluation, on j
  ContactSums sums;                  // of them over the contacts of every node

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
struct HistoryStart {
  std::span<const double> coordinates;
  std::array<double, 4> cell{};
  std::span<const ContactHistory> contacts;
  std::span<const double> moments = {};  // on j, of laws with moments: one per contact [N m]
  std::span<const double> gaps = {};     // rest - reach, of bonds across gaps: one per contact [m]
};

// Fill the list for a cell from pairs (ordered) and the history (ordered alike). A contact of the history that
// is not among the pairs has opened and is forgotten. pair_weights is empty or holds 1
// or 1/copies; forces are summed over the nodes that the particles belong to.
void build_contacts(std::span<const NeighbourPair> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, std::span<const int> node, std::size_t nodes,
                    const ContactLaw& law, const std::array<double, 4>& cell,
                    const HistoryStart& start, ContactList& list);

}  // namespace grainlaw
