// First-order changes of contacts under motions of the nodes and changes of F, several at once.
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"
#include "tangent/disc_history.hpp"
#include "tangent/sphere_history.hpp"
#include "tangent/stiffness.hpp"

#include <span>

namespace grainlaw::core {

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

}  // namespace grainlaw::core
