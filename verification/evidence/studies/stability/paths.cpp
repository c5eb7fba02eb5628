#include "evidence/studies/stability/paths.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace verification::stability {

template <>
TensorOf<2> rotation(double angle) {
  TensorOf<2> q;
  q << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return q;
}

template <>
TensorOf<3> rotation(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
}

template <int D>
TensorOf<D> simple_shear(double amount) {
  TensorOf<D> f = TensorOf<D>::Identity();
  f(0, D - 1) = amount;
  return f;
}

template <int D>
TensorOf<D> isochoric(double strain) {
  TensorOf<D> f = TensorOf<D>::Identity() * std::exp(strain / (D - 1));
  f(D - 1, D - 1) = std::exp(-strain);
  return f;
}

template <int D>
TensorOf<D> isotropic(double stretch) {
  return stretch * TensorOf<D>::Identity();
}

int steps_of_turns(double angle, double turns) {
  return static_cast<int>(std::ceil(2 * std::numbers::pi * turns / angle));
}

template <int D>
TargetsOf<D> random_walk(unsigned seed, int steps, double size, double bound) {
  // The engine's bits are fixed by the standard; what its distributions make of them is not.
  std::mt19937_64 engine(seed);
  const auto random = [&] {
    return 2 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1;  // -1..1
  };
  TensorOf<D> f = TensorOf<D>::Identity();
  TargetsOf<D> targets;
  while (static_cast<int>(targets.size()) < steps) {
    TensorOf<D> step;
    for (int k = 0; k < D * D; ++k) step.data()[k] = size * random();
    TensorOf<D> next = f + step;
    const auto inside = [&](const TensorOf<D>& g) {
      const double volume = g.determinant();
      return (g - TensorOf<D>::Identity()).cwiseAbs().maxCoeff() <= bound && volume <= 1 &&
             volume >= 1 - 2 * bound;
    };
    if (!inside(next)) {
      // Back towards a dense state in the middle, no further than a step.
      const TensorOf<D> way = isotropic<D>(1 - 0.5 * bound) - f;
      next = f + way * std::min(1.0, size / way.cwiseAbs().maxCoeff());
    }
    f = next;
    targets.push_back(f);
  }
  return targets;
}

#define GRAINLAW_FOR(D)                         \
  template TensorOf<D> simple_shear<D>(double); \
  template TensorOf<D> isochoric<D>(double);    \
  template TensorOf<D> isotropic<D>(double);    \
  template TargetsOf<D> random_walk<D>(unsigned, int, double, double);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace verification::stability
