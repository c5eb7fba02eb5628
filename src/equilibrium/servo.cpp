#include "equilibrium/chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainlaw {

namespace {

// Boundary particles to F X + n_f (x - F X at the start), rotations kept (Table 2, 2.1.A; with n_f
// = 0 Table 3, 1.1.A). Keeping rotations instead of Q = I, and rotating with F, is what makes it
// objective.
void predict_boundary(Increment& increment, double inheritance) {
  const auto& packing = *increment.problem->packing;
  const auto n = packing.size();
  const auto& f = increment.deformation;
  const auto& f0 = increment.start_deformation;
  for (const int q : packing.frame->boundary) {
    const auto p = static_cast<std::size_t>(q);
    const double x = packing.position[p];
    const double y = packing.position[n + p];
    const double wx = increment.start[p] - f0[0] * x - f0[1] * y;
    const double wy = increment.start[n + p] - f0[2] * x - f0[3] * y;
    increment.coordinates[p] = f[0] * x + f[1] * y + inheritance * wx;
    increment.coordinates[n + p] = f[2] * x + f[3] * y + inheritance * wy;
  }
}

}  // namespace

bool solve_servo(Increment& increment, const SolverOptions& options, double tolerance,
                 RelaxationMemory& memory) {
  const auto& space = *increment.problem->space;
  const auto& packing = *increment.problem->packing;
  const auto& law = *increment.problem->law;
  const auto& servo = space.options.servo;
  const auto nodes = increment.nodes();
  const bool rotating = law.rotating();

  double smallest = 1e300;
  for (std::size_t q = 0; q < nodes; ++q) {
    if (space.boundary[q]) smallest = std::min(smallest, increment.node_radius[q]);
  }
  const double lightest =
      packing.density * std::numbers::pi * smallest * smallest * packing.thickness;
  const double dt =
      options.published.time_step_ratio * std::sqrt(lightest / law.stiffness(smallest, smallest));

  predict_boundary(increment, servo.inheritance);
  increment.keep_neighbours();
  auto& step = memory.correction;
  step.assign(increment.unknowns(), 0.0);
  for (int correction = 0; correction <= servo.max_corrections; ++correction) {
    if (!relax_published(increment, tolerance, options.published, space.boundary, memory)) {
      return false;
    }
    const auto r = increment.residual();
    double sum = 0;
    for (std::size_t q = 0; q < nodes; ++q) {
      if (!space.boundary[q]) continue;
      const double radius = increment.node_radius[q];
      const double kn = law.stiffness(radius, radius);
      const double share = smallest * smallest / (radius * radius);  // gains scale with 1/M
      const double m = packing.density * std::numbers::pi * radius * radius * packing.thickness;
      const double force_scale = m * radius / (dt * dt);  // eq. 37
      if (!space.fixed[q]) {
        for (std::size_t k = 0; k < 2; ++k) {
          // The boundary force a balances the contact forces, so a+ + a- = -r and du = -g (a+ +
          // a-).
          step[k * nodes + q] = servo.gain_force / kn * share * r[k * nodes + q];
          sum += std::pow(r[k * nodes + q] / force_scale, 2);
        }
      }
      if (rotating) {
        const double moment = r[2 * nodes + q];
        step[2 * nodes + q] = servo.gain_moment / (kn * radius * radius) * share * moment;
        sum += std::pow(moment / (force_scale * radius), 2);
      }
    }
    if (std::sqrt(sum) <= servo.tolerance) return true;
    increment.move(step);
    increment.advance_history();
    increment.keep_neighbours();
    ++increment.servo_corrections;
  }
  return false;
}

}  // namespace grainlaw
