#include "equilibrium/newton.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw {

namespace {

// sqrt(sum (r - a m dz)^2 / m): the part of the residual that the flow does not explain.
double defect_norm(const Increment& increment, std::span<const double> step, double a) {
  const double* r = increment.residual().data();
  const double* m = increment.mass.data();
  double sum = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double value = r[k] - a * m[k] * step[k];
    sum += value * value / m[k];
  }
  return std::sqrt(sum);
}

// Largest move of a particle's surface under the step [m].
double largest_move(const Increment& increment, std::span<const double> step) {
  const auto nodes = increment.nodes();
  double largest = 0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double lever = k < 2 * nodes ? 1.0 : increment.node_radius[k % nodes];
    largest = std::max(largest, std::abs(step[k]) * lever);
  }
  return largest;
}

}  // namespace

bool flow_newton(Increment& increment, double tolerance, int max_factorisations,
                 NewtonMemory& memory) {
  constexpr double first_shift = 1e-4;
  constexpr double least_shift = 1e-7;
  constexpr double largest_shift = 1e3;
  constexpr double acceptable = 0.9;
  constexpr double good = 0.1;
  constexpr double move_limit = 0.2;  // of the smallest radius
  memory.step.assign(increment.unknowns(), 0.0);
  const double smallest =
      *std::min_element(increment.node_radius.begin(), increment.node_radius.end());

  double shift = first_shift;
  increment.refresh_masses();
  double norm = defect_norm(increment, memory.step, 0);
  for (int count = 0; count < max_factorisations; ++count) {
    if (increment.residual_norm() < tolerance) return true;
    memory.stiffness.assemble(increment, shift);
    const auto r = increment.residual();
    memory.residual.assign(r.begin(), r.end());
    memory.stiffness.factorise(increment);
    if (!memory.stiffness.solve(increment, memory.residual, memory.step)) {
      shift = std::max(4 * shift, first_shift);
      if (shift > largest_shift) return false;
      continue;
    }
    memory.coordinates = increment.coordinates;
    const double cap = std::min(1.0, move_limit * smallest / largest_move(increment, memory.step));
    bool accepted = false;
    double fraction = cap;
    for (int shortening = 0; shortening < 3 && !accepted; ++shortening, fraction *= 0.3) {
      increment.coordinates = memory.coordinates;
      increment.move(memory.step, fraction);
      increment.keep_neighbours();
      increment.update_forces();
      const double error = defect_norm(increment, memory.step, fraction * shift);
      // A shortened step promises only its share of the decrease.
      if (error < (1 - fraction * (1 - acceptable)) * norm) {
        accepted = true;
        if (fraction == 1) shift /= error < good * norm ? 16 : 4;
        if (fraction < cap) shift *= 4;
        if (shift < least_shift) shift = 0;
      }
    }
    if (!accepted) {
      increment.coordinates = memory.coordinates;
      increment.keep_neighbours();
      increment.update_forces();
      shift = std::max(4 * shift, first_shift);
      if (shift > largest_shift) return false;
      continue;
    }
    increment.refresh_masses();
    norm = defect_norm(increment, memory.step, 0);
    if (!std::isfinite(norm)) return false;
  }
  return increment.residual_norm() < tolerance;
}

}  // namespace grainlaw
