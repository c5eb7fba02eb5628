// Error of the stress against run time of one material, by what a host may set.
#pragma once

#include "app/material.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace verification {

// What a host may set.
struct Choice {
  double increment = 0;       // of strain [-]
  double tolerance = 0;       // solver.tolerance [-]
  double viscous_number = 0;  // solver.viscous_number; 0: equilibrium [-]
};

// A choice along all paths of a trial. Without an error where an increment failed.
struct Tried {
  Choice choice;
  // Stress against the reference, over the largest of the path: median and most [-].
  std::optional<double> error, largest;
  double seconds = 0;  // of CPU, of one point and path
};

struct Trial {
  std::size_t axes = 0;  // of compression
  double strain = 0;     // at the end of each path [-]
  double spread = 0;     // of reference paths that differ by 1e-6 at first, as the errors [-]
  double seconds = 0;    // of one point and path, for the reference
  Choice reference;      // tolerance and increment of the reference
  std::vector<Tried> tried;
};

// Leads a packing along axes of compression at constant volume to this strain, by every choice, and in
// fine increments as a reference. `done` hears the share that is done. Throws ComputationError where
// the reference reaches nothing.
Trial try_choices(const MaterialSource& material, double strain,
                  const std::function<void(double)>& done);

// Choices that reach the end, to which none as fast is as exact: the fastest first, the most exact last.
std::vector<Tried> best_choices(const Trial& trial);

}  // namespace verification
