// What to check first of a packing that found no equilibrium at F = I.
#pragma once

#include "increment/increment.hpp"
#include "material/material.hpp"

#include <string>

namespace grainlaw::core {

// Pressure and stiffness of the packing as it is, and what was expected.
template <int D>
[[nodiscard]] std::string start_advice(const Increment<D>& increment,
                                       const MaterialDescription& description);

}  // namespace grainlaw::core
