// Force scale of residuals, and random scatter of forces.
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
  // Begins without contacts.
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
                problem.law->largest_stiffness(largest, largest);
  }
  void take(const ContactTotals& totals) {
    touching_ = totals.touching;
    mean_force_ = touching_ > 0 ? totals.force / totals.weights : 0;
  }

  // Number of contacts that touched at the last relinearisation.
  [[nodiscard]] int touching() const { return touching_; }
  [[nodiscard]] double mean_force() const { return mean_force_; }  // mean normal force [N]
  // Force that residuals are relative to [N].
  [[nodiscard]] double relative() const { return std::max(mean_force_, floor_); }
  // Largest part of a residual that rounding of coordinates causes [N], and relative [-]. No
  // smaller tolerance can be met.
  [[nodiscard]] double rounding() const { return rounding_; }
  [[nodiscard]] double relative_rounding() const {
    return touching_ > 0 ? rounding_ / relative() : 0;
  }
  // True if contact forces are below the rounding error.
  [[nodiscard]] bool below_rounding() const {
    return relative_rounding() > tuned::largest_rounding;
  }
  // Random scatter of forces, by tolerance and rounding [N].
  [[nodiscard]] double chance() const {
    return std::max(std::min(tolerance_, tuned::largest_chance) * relative(), rounding_);
  }

 private:
  int touching_ = 0;
  double mean_force_ = 0, floor_ = 0, rounding_ = 0;  // [N]
  double tolerance_ = 0;                              // of equilibria [-]
};

}  // namespace grainlaw::core
