// Derivatives of a trial's fluctuations by F, from which the next trial of the same increment starts.
#pragma once

#include "increment/problem.hpp"
#include "tangent/derivatives.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

// Keeps derivatives per node and component as a column of the nodes, component-major, for each lane.
template <int D>
void keep_slopes(const Problem<D>& problem, std::span<const ByDeformation<D>> motion,
                 std::vector<float>& slopes);

// Sums the columns times the factors of their lanes.
template <int D>
void step_along(std::span<const float> slopes, const ByDeformation<D>& factors,
                std::vector<double>& step);

}  // namespace grainlaw::core
