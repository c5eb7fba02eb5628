// First-order changes of contacts under motions of the nodes and changes of F, several at once.
#pragma once

#include "increment/increment.hpp"
#include "linear/columns.hpp"
#include "tangent/stiffness.hpp"

#include <array>
#include <span>

namespace grainlaw {

// The derivatives of one number by the components of F, one in every lane.
template <int D>
using ByDeformation = Together<Dimension<D>::lanes>;

// Of F.
template <int D>
using DeformationChange = std::array<ByDeformation<D>, squared<D>>;

// Of what the history of listed contacts starts from. Null: none.
template <int D>
struct HistoryChange;
// Turn and tangential force; moment and difference of the rotations, of laws that have moments.
template <>
struct HistoryChange<2> {
  const ByDeformation<2>* turn = nullptr;
  const ByDeformation<2>* force = nullptr;
  const ByDeformation<2>* moment = nullptr;
  const ByDeformation<2>* spin = nullptr;
};

// Of a contact that touches: force on j, branch, and the spring's force.
template <int D>
struct ContactChange {
  std::array<ByDeformation<D>, static_cast<std::size_t>(D)> force, branch;
  std::array<ByDeformation<D>, Dimension<D>::tangents> tangential_force;
};

// Add the changes of the residual with F and history, nodes fixed in their affine place, to
// `residual` (per node and component).
template <int D>
void add_residual_changes(const Increment<D>& increment, const Stiffness<D>& stiffness,
                          const DeformationChange<D>& change, const HistoryChange<D>& history,
                          std::span<ByDeformation<D>> residual);

// Changes of all touching contacts, with `motion` of the nodes (per node and component) beside.
template <int D>
void find_contact_changes(const Increment<D>& increment,
                          std::span<const TouchingContact<D>> touching,
                          const DeformationChange<D>& change, const HistoryChange<D>& history,
                          std::span<const ByDeformation<D>> motion,
                          std::span<ContactChange<D>> changes);

// Changes of the moments on j of all touching contacts, of laws that have moments: spins per contact.
template <int D>
void find_moment_changes(const Increment<D>& increment, const Stiffness<D>& stiffness,
                         const DeformationChange<D>& change, const HistoryChange<D>& history,
                         std::span<const ByDeformation<D>> motion,
                         std::span<ByDeformation<D>> changes);

}  // namespace grainlaw
