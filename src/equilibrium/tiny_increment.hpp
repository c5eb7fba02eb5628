// Increments that change forces by less than the tolerance.
#pragma once

#include "equilibrium/request.hpp"

namespace grainlaw::core {

// Tolerance that rounding leaves [-].
template <int D>
double least_tolerance(const Increment<D>& increment) {
  double rounding = increment.scale().relative_rounding();
  const auto& drag = increment.motion().drag();
  if (drag.has_inertia()) rounding += drag.rounding() / increment.scale().relative();
  return std::min(rounding, tuned::largest_rounding);
}

// Solves an increment from its affine start so that its own change of the forces is right, where
// `tolerance` is too coarse for that. Newton takes over at `hand_over`. Returns whether the residual
// ends below `tolerance`.
template <int D>
bool solve_tiny(const Request<D>& request, double tolerance, double hand_over, long steps,
                Workspace<D>& w);

}  // namespace grainlaw::core
