// Derivatives of a trial's fluctuations by F, from which the next trial of the same increment starts.
#pragma once

#include "equilibrium/request.hpp"
#include "tangent/derivatives.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Numbers that keep_slopes() keeps.
template <int D>
[[nodiscard]] std::size_t number_of_slopes(const Problem<D>& problem);

// Keeps derivatives per node and component as a column of the nodes, component-major, for each lane.
template <int D>
void keep_slopes(const Problem<D>& problem, std::span<const ByDeformation<D>> motion,
                 std::vector<float>& slopes);

// Leads the guess of a request along the slopes to its F; `step` is the memory of that. Without
// slopes the guess stays.
template <int D>
void follow_slopes(std::span<const float> slopes, std::vector<double>& step, Request<D>& request);

}  // namespace grainlaw::core
