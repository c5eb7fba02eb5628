// Stages of the strategy: ways from a configuration to the equilibrium of an increment. Each
// restarts the increment and leaves it in workspace.increment, converged or not.
#pragma once

#include "equilibrium/effort.hpp"
#include "equilibrium/request.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace grainlaw::core {

// Solves sub-increments in turn by rounds of relaxation and pseudo-transient Newton. Overloaded
// bonds break at the end of each.
template <int D>
bool solve_parts(const Request<D>& request, int parts, Workspace<D>& workspace, Outcome& outcome);

// Relaxes with advancing history: `published` by local damping or the servo, the other methods by
// viscous relaxation.
template <int D>
bool solve_advancing(const Request<D>& request, Method method, Workspace<D>& workspace,
                     Outcome& outcome);

// Solves the whole increment from the committed history by Newton, starting where a detour ended.
// About every second increment that failed at first converges this way.
template <int D>
bool solve_whole(Request<D> request, Workspace<D>& workspace, Outcome& outcome);

// Properties of a request that several stages use.

// True if the packing may lose its contacts, and with them what holds it.
template <int D>
bool may_be_free(const Request<D>& request) {
  return request.options->contacts_lost == ContactsLost::stress_free && !request.problem->inertia;
}

// Mean force of the packing at F = I, or its substitute [N].
template <int D>
double unloaded_force(const Problem<D>& problem) {
  return problem.force_floor / relative_floor;
}

// True if an increment that did not converge may approach a state without forces.
template <int D>
bool may_fade(const Request<D>& request, const Increment<D>& increment);

// Effort for one sub-increment of this request.
template <int D>
const Effort& effort_of(const Request<D>& request);

}  // namespace grainlaw::core
