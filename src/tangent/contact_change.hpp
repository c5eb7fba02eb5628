// First-order changes of contacts with motions of the nodes and changes of F, several per register.
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"
#include "tangent/disc_history.hpp"
#include "tangent/sphere_history.hpp"
#include "tangent/stiffness.hpp"

#include <span>

namespace grainlaw::core {

// Adds the changes of the residual with F and history to `residual` (per node and component), for
// affine motion of the nodes.
template <int D>
void add_residual_changes(const Increment<D>& increment, const Stiffness<D>& stiffness,
                          const DeformationChange<D>& change, const HistoryChange<D>& history,
                          std::span<ByDeformation<D>> residual);

// Computes the changes of all touching contacts, including `motion` of the nodes (per node and
// component).
template <int D>
void find_contact_changes(const Increment<D>& increment,
                          std::span<const TouchingContact<D>> touching,
                          const DeformationChange<D>& change, const HistoryChange<D>& history,
                          std::span<const ByDeformation<D>> motion,
                          std::span<ContactChange<D>> changes);

// Computes the changes of the moments on j of all touching contacts, for laws with moments: `spins`
// per contact.
template <int D>
void find_moment_changes(const Increment<D>& increment, const Stiffness<D>& stiffness,
                         const DeformationChange<D>& change, const HistoryChange<D>& history,
                         std::span<const ByDeformation<D>> motion,
                         std::span<ByDeformation<D>> changes);

}  // namespace grainlaw::core
