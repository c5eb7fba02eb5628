// A packing led to the stress that it is to have at F = I.
#pragma once

#include "state/any_state.hpp"

#include <array>
#include <string>

namespace grainlaw::core {

enum class StressRoute { proportional, isotropic, k0 };

struct Consolidation {
  StressRoute route = StressRoute::proportional;
  std::array<double, 3> axis{};  // of k0: normal of the plane whose traction is led; unit length
  double first_pressure = 0;     // isotropic, led to before all else; 0: none [Pa]
  double overconsolidation = 1;  // largest stress of the past over the one wanted [-]
  double largest_step = 0.05;    // change of the stress in one increment over its norm [-]
};

// How a consolidation went; `why` names the last stress that was carried where it failed.
struct Consolidated {
  grainlaw_status status = GRAINLAW_OK;
  std::string why;
};

// Leads the committed state to the Cauchy stress sigma[dim*dim] [Pa], holds it until drag has faded,
// and makes it the one at F = I. reached[dim*dim]: the stress there; on failure the last one that
// was carried, where the state is left.
[[nodiscard]] Consolidated consolidate(AnyState& state, const double* sigma,
                                       const Consolidation& how, double* reached);

// Tells what is wrong with a stress to consolidate to; "" when nothing is.
[[nodiscard]] std::string fault_of_stress(const AnyState& state, const double* sigma,
                                          const Consolidation& how);

}  // namespace grainlaw::core
