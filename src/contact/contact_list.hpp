// The candidate contacts of one increment, structure of arrays, with the history they start from.
#pragma once

#include "contact/history.hpp"
#include "contact/law.hpp"
#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw {

// Contact c joins i[c] and j[c]; its branch is x_j - x_i + cell * shift. Stiffness and committed
// tangential force carry the contact's weight (1 for a cell, 1/copies on a frame).
struct ContactList {
  std::vector<std::int32_t> i, j;
  std::vector<double> shift_x, shift_y;      // lattice counts [-]
  std::vector<double> reach;                 // R_i + R_j [m]
  std::vector<double> lever_i;               // lambda_i = R_i / (R_i + R_j) [-]
  std::vector<double> normal_stiffness;      // kn [N/m]
  std::vector<double> tangential_stiffness;  // kt [N/m]
  std::vector<double> start_x, start_y;      // unit normal at the start of the increment [-]
  std::vector<double> start_turn;            // lambda_i theta_i + lambda_j theta_j there [rad]
  std::vector<double> start_force;           // tangential force there [N]
  std::vector<double> weight;                // empty when all are 1 [-]
  // Result of the last force evaluation: force on j, and d * ft for the moments.
  std::vector<double> force_x, force_y, couple;

  [[nodiscard]] std::size_t size() const { return i.size(); }
  [[nodiscard]] double weight_of(std::size_t c) const { return weight.empty() ? 1.0 : weight[c]; }
  void resize(std::size_t count, bool weighted);
};

// Where the history of an increment starts: coordinates (component-major, rotations when the law
// has them), the cell there, and the touching contacts, ordered as the neighbour search orders
// pairs.
struct HistoryStart {
  std::span<const double> coordinates;
  std::array<double, 4> cell{};
  std::span<const ContactHistory> contacts;
};

// Fill the list from pairs (ordered) and the history (ordered alike). A contact of the history that
// is not among the pairs has opened and is forgotten. weight_of_pair gives 1 or 1/copies.
void build_contacts(std::span<const NeighbourPair> pairs, std::span<const double> pair_weights,
                    std::span<const double> radius, const ContactLaw& law,
                    const HistoryStart& start, ContactList& list);

}  // namespace grainlaw
