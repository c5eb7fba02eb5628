// Paths of deformation gradients, each a list of F that starts after F = I.
#pragma once

#include "app/library.hpp"

#include <functional>
#include <vector>

namespace verification::stability {

using Targets = std::vector<Tensor>;

// F(1 / steps), ..., F(1) of a function of the fraction.
Targets along(int steps, const std::function<Tensor(double)>& deformation);

Tensor rotation(double angle);
Tensor simple_shear(double amount);  // F12
Tensor isochoric(double strain);     // diag(exp(strain), exp(-strain))
Tensor isotropic(double stretch);

// 0 -> 1 -> -1 -> 0 in 4 x quarter steps, `cycles` times.
Targets cycles(int cycles, int quarter, const std::function<Tensor(double)>& deformation);

// A rotation by steps of `angle` over `turns` full turns, on top of deformation(0..1).
Targets rotating(double angle, double turns, const std::function<Tensor(double)>& deformation);

// A random walk of all four components in steps of up to `size`. It turns back where a component
// leaves I by more than `bound` or the area leaves [1 - 2 bound, 1].
Targets random_walk(unsigned seed, int steps, double size, double bound);

}  // namespace verification::stability
