// What forces that are left over are compared with.
#pragma once

#include "base/constants.hpp"
#include "contact/contact_forces.hpp"
#include "increment/motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace grainlaw::core {

class ForceScale {
 public:
  // Nothing touches yet.
  template <int D>
  void begin(const Problem<D>& problem, const Motion<D>& motion) {
    const auto radius = motion.node_radius();
    const double largest = *std::max_element(radius.begin(), radius.end());
    double extent = 0;
    for (const double x : motion.start().first(D * problem.particles())) {
      extent = std::max(extent, std::abs(x));
    }
    *this = {};
    floor_ = problem.force_floor;
    tolerance_ = problem.tolerance;
    rounding_ = tuned::contacts_of_a_particle * std::numeric_limits<double>::epsilon() * extent *
                problem.law->stiffness(largest, largest);
  }
  void take(const ContactTotals& totals) {
    touching_ = totals.touching;
    mean_force_ = touching_ > 0 ? totals.force / totals.weights : 0;
  }

  // Of the contacts that touched when it was last looked.
  [[nodiscard]] int touching() const { return touching_; }
  [[nodiscard]] double mean_force() const { return mean_force_; }  // normal [N]
  // Residuals are relative to this [N].
  [[nodiscard]] double relative() const { return std::max(mean_force_, floor_); }
  // What the rounding of coordinates leaves of a residual at worst [N], and relative [-]: no
  // tolerance below it can be met.
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] double relative_rounding() const {
    return touching_ > 0 ? rounding_ / relative() : 0;
  }
  // Whether contacts carry no more than what rounding makes of them.
  [[nodiscard]] bool drowned() const { return relative_rounding() > tuned::largest_rounding; }
  // Forces differ by this much by chance: tolerance and rounding [N].
  [[nodiscard]] double chance() const {
    return std::max(std::min(tolerance_, tuned::largest_chance) * relative(), rounding_);
  }

 private:
  int touching_ = 0;
  double mean_force_ = 0, floor_ = 0, rounding_ = 0;  // [N]
  double tolerance_ = 0;                              // of equilibria [-]
};

}  // namespace grainlaw::core
