#include "equilibrium/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

namespace {

// Masses older than this are past the stability limit: contacts have closed meanwhile.
constexpr long mass_interval = 10;

void update(Increment& increment, History history) {
  history == History::advancing ? increment.update_forces_advancing() : increment.update_forces();
}

// Every mass_interval steps: masses, mean force and neighbours of the present coordinates.
void refresh(Increment& increment, History history) {
  if (history == History::advancing) increment.advance_history();
  increment.keep_neighbours();
  increment.refresh_masses();
}

}  // namespace

bool relax(Increment& increment, double tolerance, long max_steps, History history,
           RelaxationMemory& memory) {
  constexpr double largest_damping = 1.9;
  constexpr double largest_floor = 0.5;
  constexpr long window = 100;             // steps after which the floor is reviewed
  constexpr double enough_progress = 0.5;  // of the residual, over a window
  constexpr double oscillating = 2;        // largest / smallest residual of a window
  const std::size_t size = increment.unknowns();
  memory.velocity.assign(size, 0.0);
  memory.previous.assign(size, 0.0);
  double* v = memory.velocity.data();
  double* r_old = memory.previous.data();

  double floor = 0.1;
  double window_start = std::numeric_limits<double>::infinity();
  double window_max = 0;
  double window_min = std::numeric_limits<double>::infinity();
  refresh(increment, history);
  update(increment, history);
  for (long step = 0;; ++step) {
    const double norm = increment.residual_norm();
    if (norm < tolerance || step == max_steps || !std::isfinite(norm)) {
      refresh(increment, history);
      update(increment, history);
      if (increment.residual_norm() < tolerance) return true;
      if (step == max_steps || !std::isfinite(norm)) return false;
    } else if (step % mass_interval == 0 && step > 0) {
      refresh(increment, history);
    }
    window_max = std::max(window_max, norm);
    window_min = std::min(window_min, norm);
    if (step % window == 0) {
      if (norm > enough_progress * window_start) {
        const bool flutter = window_max > oscillating * window_min;
        floor = flutter ? std::min(2 * floor, largest_floor) : 0.5 * floor;
      }
      window_start = norm;
      window_max = window_min = norm;
    }

    const double* r = increment.residual().data();
    const double* m = increment.mass.data();
    double stiffness = 0;
    double inertia = std::numeric_limits<double>::min();
#pragma omp simd reduction(+ : stiffness, inertia)
    for (std::size_t k = 0; k < size; ++k) {
      stiffness += v[k] * (r_old[k] - r[k]);
      inertia += v[k] * m[k] * v[k];
    }
    const double c =
        std::clamp(2 * std::sqrt(std::max(stiffness / inertia, 0.0)), floor, largest_damping);
    const double keep = (2 - c) / (2 + c);
    const double gain = 2 / (2 + c);
#pragma omp simd
    for (std::size_t k = 0; k < size; ++k) {
      v[k] = keep * v[k] + gain * r[k] / m[k];
      r_old[k] = r[k];
    }
    increment.move(memory.velocity);
    update(increment, history);
    ++increment.relaxation_steps;
  }
}

}  // namespace grainlaw
