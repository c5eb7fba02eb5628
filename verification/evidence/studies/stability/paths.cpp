#include "evidence/studies/stability/paths.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace verification::stability {

Targets along(int steps, const std::function<Tensor(double)>& deformation) {
  Targets targets;
  for (int k = 1; k <= steps; ++k) targets.push_back(deformation(static_cast<double>(k) / steps));
  return targets;
}

Tensor rotation(double angle) {
  Tensor q;
  q << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return q;
}

Tensor simple_shear(double amount) {
  Tensor f;
  f << 1, amount, 0, 1;
  return f;
}

Tensor isochoric(double strain) {
  Tensor f;
  f << std::exp(strain), 0, 0, std::exp(-strain);
  return f;
}

Tensor isotropic(double stretch) { return stretch * Tensor::Identity(); }

Targets cycles(int cycles, int quarter, const std::function<Tensor(double)>& deformation) {
  Targets targets;
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (int k = 1; k <= 4 * quarter; ++k) {
      const double phase = static_cast<double>(k) / quarter;
      const double share = phase <= 1 ? phase : phase <= 3 ? 2 - phase : phase - 4;
      targets.push_back(deformation(share));
    }
  return targets;
}

Targets rotating(double angle, double turns, const std::function<Tensor(double)>& deformation) {
  const int steps = static_cast<int>(std::ceil(2 * std::numbers::pi * turns / angle));
  Targets targets;
  for (int k = 1; k <= steps; ++k)
    targets.push_back(rotation(k * angle) * deformation(static_cast<double>(k) / steps));
  return targets;
}

Targets random_walk(unsigned seed, int steps, double size, double bound) {
  // The engine's bits are fixed by the standard; what its distributions make of them is not.
  std::mt19937_64 engine(seed);
  const auto random = [&] {
    return 2 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1;  // -1..1
  };
  Tensor f = Tensor::Identity();
  Targets targets;
  while (static_cast<int>(targets.size()) < steps) {
    Tensor step;
    for (int k = 0; k < 4; ++k) step.data()[k] = size * random();
    Tensor next = f + step;
    const auto inside = [&](const Tensor& g) {
      const double area = g.determinant();
      return (g - Tensor::Identity()).cwiseAbs().maxCoeff() <= bound && area <= 1 &&
             area >= 1 - 2 * bound;
    };
    if (!inside(next)) {
      // Back towards a dense state in the middle, no further than a step.
      const Tensor way = isotropic(1 - 0.5 * bound) - f;
      next = f + way * std::min(1.0, size / way.cwiseAbs().maxCoeff());
    }
    f = next;
    targets.push_back(f);
  }
  return targets;
}

}  // namespace verification::stability
