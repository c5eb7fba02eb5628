#include "state/time_step.hpp"

#include "base/constants.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

template <int D>
double duration_of(const Material<D>& material, const Configuration<D>& committed,
                   const Tensor<D>& F, double time_step) {
  const Viscosity& viscosity = material.solver.viscosity;
  const bool inertia = material.solver.inertia;
  if (viscosity.rate == 0 && !inertia) return by_strain;
  double squares = 0;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    const double change = F[k] - committed.deformation[k];
    squares += change * change;
  }
  const bool held = std::sqrt(squares) <= tuned::largest_held_strain;
  if (!held && !(time_step > 0)) {
    throw Error(GRAINLAW_BAD_ARGUMENT,
                inertia ? "the material has solver.inertia and was told no time step above 0: tell "
                          "the host's in s before the increment (grainlaw_state_set_time_step)"
                        : "the material has solver.viscous_rate and was told no time step above 0: "
                          "tell the host's before the increment (grainlaw_state_set_time_step), or "
                          "leave viscous_rate out, so that the strain is the time");
  }
  if (inertia) return std::max(time_step, 0.0);
  return std::max(time_step, 0.0) * viscosity.rate / viscosity.number;
}

template double duration_of(const Material<2>&, const Configuration<2>&, const Tensor<2>&, double);
template double duration_of(const Material<3>&, const Configuration<3>&, const Tensor<3>&, double);

}  // namespace grainlaw::core
