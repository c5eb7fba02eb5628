#include "generate/anisotropic.hpp"

#include "base/error.hpp"
#include "homogenise/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

constexpr double good = 0.004;  // error of A that ends the search
constexpr double allowed = 0.005;
constexpr double near_direction = 0.02;  // in space, with a good A
constexpr int most_steps = 60;
constexpr double largest_step = 0.1;   // step of the deviatoric stress over the pressure
constexpr double largest_ratio = 0.8;  // beyond any packing's strength
// Fabric eigenvalue difference per deviatoric stress ratio: first estimate, and least value used.
constexpr double first_gain = 0.25;
constexpr double least_gain = 0.05;

template <int D>
using Deviator = std::array<double, StressTarget<D>::deviators>;

// Deviatoric fabric: half the eigenvalue difference times (cos 2a, sin 2a), a the major direction;
// in space its components.
template <int D>
Deviator<D> deviatoric_fabric(const StressControl<D>& control) {
  Tensor<D> fabric{};
  measure(control.problem(), control.configuration(), GRAINLAW_FABRIC, fabric.data());
  if constexpr (D == 2) {
    return {0.5 * (fabric[0] - fabric[3]), fabric[1]};
  } else {
    return {fabric[0] - 1.0 / 3, fabric[4] - 1.0 / 3, fabric[8] - 1.0 / 3,
            fabric[5],           fabric[2],           fabric[1]};
  }
}

template <int D>
Deviator<D> wanted_fabric(const GeneratorOptions& options) {
  const double anisotropy = options.anisotropy;
  if constexpr (D == 2) {
    const double size = 0.5 * anisotropy / (2 + anisotropy);
    const double direction = options.anisotropy_direction;
    return {size * std::cos(2 * direction), size * std::sin(2 * direction)};
  } else {
    const double difference = anisotropy / (3 + anisotropy);  // half the difference of the
                                                              // eigenvalues
    Vec<3> e = options.anisotropy_axis;
    const double size = length<3>(e);
    for (double& component : e) component /= size;
    return {difference * (e[0] * e[0] - 1.0 / 3),
            difference * (e[1] * e[1] - 1.0 / 3),
            difference * (e[2] * e[2] - 1.0 / 3),
            difference * e[1] * e[2],
            difference * e[0] * e[2],
            difference * e[0] * e[1]};
  }
}

// Norm of the deviator as a tensor.
double norm(const Deviator<2>& a) { return std::hypot(a[0], a[1]); }
double norm(const Deviator<3>& a) {
  double squares = 0;
  for (std::size_t k = 0; k < 6; ++k) squares += (k < 3 ? 1 : 2) * a[k] * a[k];
  return std::sqrt(squares);
}

// a + factor b.
template <std::size_t size>
std::array<double, size> sum(std::array<double, size> a, double factor,
                             const std::array<double, size>& b) {
  for (std::size_t k = 0; k < size; ++k) a[k] += factor * b[k];
  return a;
}

template <int D>
double anisotropy_of(const StressControl<D>& control) {
  const auto fabric = deviatoric_fabric(control);
  if constexpr (D == 2) {
    const double d = norm(fabric);
    return (0.5 + d) / (0.5 - d) - 1;
  } else {
    const Vec<3> values = principal_values({fabric[0], fabric[5], fabric[4], fabric[5], fabric[1],
                                            fabric[3], fabric[4], fabric[3], fabric[2]});
    return (1.0 / 3 + values[2]) / (1.0 / 3 + values[0]) - 1;
  }
}

}  // namespace

template <int D>
void consolidate_anisotropically(StressControl<D>& control, StressTarget<D> target,
                                 const GeneratorOptions& options) {
  const auto wanted = wanted_fabric<D>(options);
  target.free_shear = false;
  double gain = first_gain;
  double lowest = anisotropy_of(control);
  double highest = lowest;
  Deviator<D> last{};
  double last_step = 0;
  constexpr double on_the_way = D == 2 ? StressControl<D>::tight : 1e-3;
  bool bears = true;  // the target, where the last step ended
  for (int k = 0; k < most_steps && (bears = control.reach(target, on_the_way)); ++k) {
    const auto found = deviatoric_fabric(control);
    const double a = anisotropy_of(control);
    lowest = std::min(lowest, a);
    highest = std::max(highest, a);
    const auto miss = sum(wanted, -1, found);
    const double distance = norm(miss);
    // A is about 4 d, and an error in direction counts like one in size.
    if (4 * distance < good) {
      if (D == 2 || control.reach(target)) return;
      break;
    }
    // In space five numbers must fit, and few contacts cannot meet them all.
    if (D == 3 && std::abs(a - options.anisotropy) < good && 4 * distance < near_direction) {
      control.reach(target);
      break;
    }
    if (k > 0 && last_step > 0) {
      const double moved = norm(sum(found, -1, last));
      gain = std::clamp(moved / last_step, least_gain, 2 * gain);
    }
    last = found;
    const double share = std::min(1.0, largest_step * gain / distance) / gain;
    target.deviator = sum(target.deviator, share, miss);
    last_step = share * distance;
    if (norm(target.deviator) > largest_ratio) break;
  }
  if (bears && std::abs(anisotropy_of(control) - options.anisotropy) < allowed) return;
  throw Error(GRAINLAW_NOT_CONVERGED,
              fmt::format("generator: anisotropy = {} was not met, found {:.4f} to {:.4f}; try "
                          "another seed or more {}",
                          options.anisotropy, lowest, highest, D == 2 ? "discs" : "spheres"));
}

template void consolidate_anisotropically(StressControl<2>&, StressTarget<2>,
                                          const GeneratorOptions&);
template void consolidate_anisotropically(StressControl<3>&, StressTarget<3>,
                                          const GeneratorOptions&);

}  // namespace grainlaw::core
