// The stages of the strategy: ways from a configuration to the equilibrium of an increment. Each begins
// the increment anew, and leaves it in workspace.increment whether it got there or not.
#pragma once

#include "equilibrium/request.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace grainlaw::core {

// Sub-increments in turn, each by rounds of relaxation and pseudo-transient Newton; bonds that are
// beyond their strength break at the end of each.
template <int D>
bool solve_parts(const Request<D>& request, int parts, Workspace<D>& workspace, Outcome& outcome);

// Relaxation with advancing history, by the method asked for: chain and advancing by viscous
// relaxation, published by local damping or the servo.
template <int D>
bool solve_advancing(const Request<D>& request, Method method, Workspace<D>& workspace,
                     Outcome& outcome);

// The increment as a whole, from the committed history, by Newton near where a detour ended: about every
// other one that was missed at first is found so.
template <int D>
bool solve_whole(Request<D> request, Workspace<D>& workspace, Outcome& outcome);

// What the stages ask of a request.

// Whether contacts may be lost.
template <int D>
bool may_be_free(const Request<D>& request) {
  return request.options->contacts_lost == ContactsLost::stress_free;
}

// Mean force of the packing at F = I, or what stands for it [N].
template <int D>
double unloaded_force(const Problem<D>& problem) {
  return problem.force_floor / relative_floor;
}

// Whether an increment that did not settle may be on its way to where all forces fade.
template <int D>
bool may_fade(const Request<D>& request, const Increment<D>& increment);

// What is spent on one sub-increment with up to tuned::usual_nodes before others are tried.
struct Effort {
  int rounds;                // of relaxation and Newton
  int first_factorisations;  // where Newton works at once, it works soon
  int most_factorisations;
  double relaxation_steps;
  int finest;  // sub-increments, times those that the size of the increment asks for
};
template <int D>
const Effort& effort_of(const Request<D>& request);

}  // namespace grainlaw::core
