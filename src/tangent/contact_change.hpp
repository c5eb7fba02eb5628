// First-order changes of contacts under motions of the nodes and changes of F, four at once.
#pragma once

#include "increment/increment.hpp"
#include "linear/block_matrix.hpp"
#include "tangent/stiffness.hpp"

#include <array>
#include <span>

namespace grainlaw {

// Of F (row-major); a lane per change.
using DeformationChange = std::array<Quad, 4>;

// Of what the history of listed contacts starts from: turn and tangential force; moment and
// difference of the rotations, of laws that have moments. Null: none.
struct HistoryChange {
  const Quad* turn = nullptr;
  const Quad* force = nullptr;
  const Quad* moment = nullptr;
  const Quad* spin = nullptr;
};

// Change of the force on j (x, y) and of the branch (x, y) of a contact that touches.
struct ContactChange {
  Quad force_x, force_y, branch_x, branch_y, tangential_force;
};

// Add the changes of the residual with F and history, nodes fixed in their affine place, to
// `residual` (per node and component).
void add_residual_changes(const Increment& increment, const Stiffness& stiffness,
                          const DeformationChange& change, const HistoryChange& history,
                          std::span<Quad> residual);

// Changes of all touching contacts, with `motion` of the nodes (per node and component) beside.
void find_contact_changes(const Increment& increment, std::span<const TouchingContact> touching,
                          const DeformationChange& change, const HistoryChange& history,
                          std::span<const Quad> motion, std::span<ContactChange> changes);

// Changes of the moments on j of all touching contacts, of laws that have moments.
void find_moment_changes(const Increment& increment, const Stiffness& stiffness,
                         const DeformationChange& change, const HistoryChange& history,
                         std::span<const Quad> motion, std::span<Quad> changes);

}  // namespace grainlaw
