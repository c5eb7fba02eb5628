// Paths of deformation gradients, each a list of F that starts after F = I. Without an argument
// functions are of discs.
#pragma once

#include "app/library.hpp"

#include <type_traits>
#include <vector>

namespace verification::stability {

template <int D>
using TargetsOf = std::vector<TensorOf<D>>;
using Targets = TargetsOf<2>;

// By `angle`, in space about an axis that is none of a cell's.
template <int D = 2>
TensorOf<D> rotation(double angle);
// Component 1D of F.
template <int D = 2>
TensorOf<D> simple_shear(double amount);
// Along the last axis exp(-strain).
template <int D = 2>
TensorOf<D> isochoric(double strain);
template <int D = 2>
TensorOf<D> isotropic(double stretch);

// F(1 / steps), ..., F(1) of a function of the fraction.
template <class Deformation>
auto along(int steps, const Deformation& deformation) {
  std::vector<std::invoke_result_t<Deformation, double>> targets;
  for (int k = 1; k <= steps; ++k) targets.push_back(deformation(static_cast<double>(k) / steps));
  return targets;
}

// 0 -> 1 -> -1 -> 0 in 4 x quarter steps, `cycles` times.
template <class Deformation>
auto cycles(int cycles, int quarter, const Deformation& deformation) {
  std::vector<std::invoke_result_t<Deformation, double>> targets;
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (int k = 1; k <= 4 * quarter; ++k) {
      const double phase = static_cast<double>(k) / quarter;
      const double share = phase <= 1 ? phase : phase <= 3 ? 2 - phase : phase - 4;
      targets.push_back(deformation(share));
    }
  return targets;
}

// There and back again in `quarter` steps each way.
template <class Deformation>
auto there_and_back(int quarter, const Deformation& deformation) {
  auto targets = along(quarter, deformation);
  for (int k = quarter - 1; k >= 0; --k)
    targets.push_back(deformation(static_cast<double>(k) / quarter));
  return targets;
}

// A rotation by steps of `angle` over `turns` full turns, on top of targets of as many steps.
template <int D>
TargetsOf<D> rotated(double angle, TargetsOf<D> targets) {
  for (std::size_t k = 0; k < targets.size(); ++k)
    targets[k] = rotation<D>(static_cast<double>(k + 1) * angle) * targets[k];
  return targets;
}
int steps_of_turns(double angle, double turns);

// A random walk of all components in steps of up to `size`. It turns back where a component
// leaves I by more than `bound` or the volume leaves [1 - 2 bound, 1].
template <int D = 2>
TargetsOf<D> random_walk(unsigned seed, int steps, double size, double bound);

}  // namespace verification::stability
