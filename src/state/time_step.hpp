// Time as a host tells it, and how long an increment lasts by it.
#pragma once

#include "equilibrium/request.hpp"
#include "increment/configuration.hpp"
#include "material/material.hpp"

namespace grainlaw::core {

// The time step of a state that no host has told one.
inline constexpr double untold = -1;

// Duration of the increment from `committed` to F [memories; with inertia s], or `by_strain`.
// Throws Error (BAD_ARGUMENT) where the material asks for a time step, F moves and there is none
// above 0.
template <int D>
[[nodiscard]] double duration_of(const Material<D>& material, const Configuration<D>& committed,
                                 const Tensor<D>& F, double time_step);

}  // namespace grainlaw::core
