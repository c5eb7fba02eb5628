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
constexpr int most_steps = 60;
constexpr double largest_step = 0.1;   // of the deviatoric stress, over the pressure
constexpr double largest_ratio = 0.8;  // no packing bears more
// Eigenvalue difference of the fabric by deviatoric stress ratio: of the first step, and the least
// that is believed.
constexpr double first_gain = 0.25;
constexpr double least_gain = 0.05;

using Pair = std::array<double, 2>;

// Half the difference of the fabric's eigenvalues times (cos 2a, sin 2a) of the major direction a.
Pair deviatoric_fabric(const StressControl& control) {
  std::array<double, 4> fabric{};
  measure(control.problem(), control.configuration(), GRAINLAW_FABRIC, fabric.data());
  return {0.5 * (fabric[0] - fabric[3]), fabric[1]};
}

double anisotropy_of(const Pair& fabric) {
  const double d = std::hypot(fabric[0], fabric[1]);
  return (0.5 + d) / (0.5 - d) - 1;
}

}  // namespace

void consolidate_anisotropically(StressControl& control, StressTarget target, double anisotropy,
                                 double direction) {
  const double size = 0.5 * anisotropy / (2 + anisotropy);
  const Pair wanted = {size * std::cos(2 * direction), size * std::sin(2 * direction)};
  target.free_shear = false;
  double gain = first_gain;
  double lowest = anisotropy_of(deviatoric_fabric(control));
  double highest = lowest;
  Pair last{};
  double last_step = 0;
  for (int k = 0; k < most_steps && control.reach(target); ++k) {
    const Pair found = deviatoric_fabric(control);
    const double a = anisotropy_of(found);
    lowest = std::min(lowest, a);
    highest = std::max(highest, a);
    const Pair miss = {wanted[0] - found[0], wanted[1] - found[1]};
    const double distance = std::hypot(miss[0], miss[1]);
    // A is about 4 d; the direction counts as much as the size.
    if (4 * distance < good) return;
    if (k > 0 && last_step > 0) {
      const double moved = std::hypot(found[0] - last[0], found[1] - last[1]);
      gain = std::clamp(moved / last_step, least_gain, 2 * gain);
    }
    last = found;
    const double share = std::min(1.0, largest_step * gain / distance) / gain;
    target.deviator = {target.deviator[0] + share * miss[0], target.deviator[1] + share * miss[1]};
    last_step = share * distance;
    if (std::hypot(target.deviator[0], target.deviator[1]) > largest_ratio) break;
  }
  if (std::abs(anisotropy_of(deviatoric_fabric(control)) - anisotropy) < allowed) return;
  throw Error(GRAINLAW_NOT_CONVERGED,
              fmt::format("generator: anisotropy = {} was not met, found {:.4f} to {:.4f}; try "
                          "another seed or more discs",
                          anisotropy, lowest, highest));
}

}  // namespace grainlaw::core
