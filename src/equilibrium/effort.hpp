// Effort that a sub-increment is worth, by the tolerance and the number of particles.
#pragma once

#include "base/constants.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grainlaw::core {

// For one sub-increment of up to tuned::usual_nodes before other stages.
struct Effort {
  int rounds;                // of relaxation and Newton
  int first_factorisations;  // of the first round
  int most_factorisations;
  double relaxation_steps;
  int finest;  // largest refinement of the number of sub-increments
};

inline constexpr Effort full_effort{.rounds = tuned::rounds,
                                    .first_factorisations = tuned::first_factorisations,
                                    .most_factorisations = tuned::most_factorisations,
                                    .relaxation_steps = tuned::relaxation_steps,
                                    .finest = tuned::finest_refinement};
// Effort with a loose tolerance.
inline constexpr Effort bounded_effort{.rounds = tuned::bounded_rounds,
                                       .first_factorisations = tuned::bounded_first_factorisations,
                                       .most_factorisations = tuned::bounded_factorisations,
                                       .relaxation_steps = tuned::bounded_relaxation_steps,
                                       .finest = 1};

// Fewer rounds: an increment that fluttered before in this step rarely converges now.
constexpr Effort repeated(Effort effort) {
  effort.rounds = tuned::repeated_rounds;
  return effort;
}
inline constexpr Effort repeated_effort = repeated(bounded_effort);

inline double size_factor(std::size_t nodes) {
  return std::sqrt(std::max(1.0, static_cast<double>(nodes) / tuned::usual_nodes));
}

inline long relaxation_limit(double steps, std::size_t nodes) {
  return static_cast<long>(steps * size_factor(nodes));
}

// Count for large packings, at least `least`. Sub-increments are cheaper there: all rounds cost
// fifty increments in a packing of 6400 discs that did not converge.
inline int limit_of(int count, int least, std::size_t nodes) {
  const long fewer = std::lround(count / size_factor(nodes));
  return std::min(count, std::max(least, static_cast<int>(fewer)));
}

template <int D>
double hand_over_of(std::size_t nodes) {
  const double share = tuned::usual_nodes / static_cast<double>(nodes);
  return tuned::hand_over<D> * std::pow(std::min(1.0, share), tuned::hand_over_power);
}

}  // namespace grainlaw::core
