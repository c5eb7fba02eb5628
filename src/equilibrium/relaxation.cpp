#include "equilibrium/relaxation.hpp"

#include "contact/frictional.hpp"
#include "simd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

namespace {

using namespace simd;
constexpr std::size_t width = 4;

// Masses older than this are past the stability limit: contacts have closed meanwhile.
constexpr long mass_interval = 10;

// One record per node: translation, and rotation as turned length R theta. Its force M / R makes
// every component a force, and its mass is I / R^2.
struct Nodes {
  double* velocity;
  double* previous;  // residual of the last step
  const double* residual;
  const double* mass;
  double* gain;  // 1 / mass, and 0 where nothing moves
  std::size_t doubles;
};

struct Measured {
  double largest;    // component of the residual [N]
  double stiffness;  // sum v (r_previous - r)
  double inertia;    // sum v m v
};

// v <- keep v + gain r / m, and z <- z + v for the record of every node; what is measured is of the
// state before.
GRAINLAW_CLONES Measured step_nodes(const Nodes& nodes, double keep, double gain, double* z) {
  Record largest_force{};
  Record stiffness{};
  Record inertia{};
  for (std::size_t k = 0; k < nodes.doubles; k += width) {
    const Record r = load<4>(nodes.residual + k);
    const Record v = load<4>(nodes.velocity + k);
    largest_force = largest(largest_force, magnitude(r));
    stiffness += v * (load<4>(nodes.previous + k) - r);
    inertia += v * load<4>(nodes.mass + k) * v;
    const Record next = keep * v + gain * r * load<4>(nodes.gain + k);
    store(nodes.velocity + k, next);
    store(nodes.previous + k, r);
    if (z != nullptr) store(z + k, load<4>(z + k) + next);
  }
  return {most(largest_force), sum(stiffness), sum(inertia)};
}

GRAINLAW_CLONES void find_gains(const double* mass, double* gain, std::size_t doubles) {
  for (std::size_t k = 0; k < doubles; k += width) store(gain + k, 1 / load<4>(mass + k));
}

}  // namespace

Relaxation::Relaxation(Increment& increment, History history, RelaxationMemory& memory)
    : increment_(increment), history_(history), memory_(memory) {
  for (auto* column : {&memory.velocity, &memory.previous, &memory.gain}) {
    column->assign(width * increment.forces.size(), 0.0);
  }
}

// Masses, mean force and neighbours of the present coordinates.
void Relaxation::refresh() {
  if (history_ == History::advancing) increment_.advance_history();
  increment_.keep_neighbours();
  increment_.sum_masses();
  find_gains(&increment_.mass_records[0].x, memory_.gain.data(), memory_.gain.size());
  const auto& space = *increment_.problem->space;
  if (space.identity) return;
  double* gain = memory_.gain.data();
  for (std::size_t q = 0; q < increment_.nodes(); ++q, gain += width) {
    if ((space.fixed[q] & fixed_x) != 0) gain[0] = 0;
    if ((space.fixed[q] & fixed_y) != 0) gain[1] = 0;
    if ((space.fixed[q] & fixed_rotation) != 0) gain[2] = 0;
  }
  if (!space.finds_deformation) return;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!space.found[k]) gain[width * (k / 2) + k % 2] = 0;
  }
}

void Relaxation::update() {
  const auto& law = *increment_.problem->law;
  auto& forces = increment_.forces;
  if (history_ == History::advancing) {
    increment_.dissipated +=
        advance_contacts(increment_.records, law, increment_.contacts, forces);
  } else {
    evaluate_contacts(increment_.records, law, increment_.contacts, forces);
  }
  increment_.reduce(forces);
}

// A high floor keeps flutter down, a low one lets soft modes move.
void Relaxation::review_floor() {
  constexpr double largest_floor = 0.5;
  constexpr double enough_progress = 0.5;  // of the residual, over a window
  constexpr double oscillating = 2;        // largest / smallest residual of a window
  if (residual_ > enough_progress * window_start_) {
    const bool flutter = window_max_ > oscillating * window_min_;
    floor_ = flutter ? std::min(2 * floor_, largest_floor) : 0.5 * floor_;
  }
  window_start_ = window_max_ = window_min_ = residual_;
}

// With the damping that the last step measured.
void Relaxation::step() {
  constexpr double largest_damping = 1.9;
  const double damping = std::clamp(2 * frequency_, floor_, largest_damping);
  const Nodes nodes{memory_.velocity.data(),        memory_.previous.data(),
                    &increment_.forces[0].x,        &increment_.mass_records[0].x,
                    memory_.gain.data(),            memory_.velocity.size()};
  const auto& space = *increment_.problem->space;
  double* z = &increment_.records[0].x;
  const auto before = step_nodes(nodes, (2 - damping) / (2 + damping), 2 / (2 + damping),
                                 space.identity ? z : nullptr);
  residual_ = std::numeric_limits<double>::infinity();
  if (increment_.touching > 0 && std::isfinite(before.stiffness + before.largest)) {
    residual_ = before.largest / increment_.relative_scale();
  }
  const double inertia = std::max(before.inertia, std::numeric_limits<double>::min());
  frequency_ = std::sqrt(std::max(before.stiffness / inertia, 0.0));
  ++steps_;
  ++increment_.relaxation_steps;
  if (space.identity) return;
  if (space.finds_deformation) step_deformation();
  for (std::size_t p = 0; p < increment_.particles(); ++p) {
    const double* v = memory_.velocity.data() + width * static_cast<std::size_t>(space.node[p]);
    store(z + width * p, load<4>(z + width * p) + load<4>(v));
  }
}

// Found components of F move on with the nodes, never far in one step.
void Relaxation::step_deformation() {
  constexpr double largest_change = 1e-3;
  const double limit = largest_change * increment_.deformation_scale();
  double* v = memory_.velocity.data() + width * increment_.nodes();
  for (std::size_t k = 0; k < 2 * width; ++k) v[k] = std::clamp(v[k], -limit, limit);
  increment_.change_deformation(v, increment_.records);
}

bool Relaxation::run(double tolerance, long steps) {
  constexpr long window = 100;  // steps after which the floor is reviewed
  increment_.load_records();
  refresh();
  increment_.update_forces();
  if (increment_.residual_norm() < tolerance) return true;
  for (const long last = steps_ + steps;;) {
    step();
    update();
    const bool over = residual_ < tolerance || steps_ == last || !std::isfinite(residual_);
    if (over || steps_ % mass_interval == 0) {
      increment_.store_records();
      refresh();
      if (increment_.problem->space->averages()) increment_.take_averages(increment_.forces);
    }
    if (over) {
      increment_.update_forces();
      if (increment_.residual_norm() < tolerance) return true;
      if (steps_ == last || !std::isfinite(residual_)) return false;
    }
    window_max_ = std::max(window_max_, residual_);
    window_min_ = std::min(window_min_, residual_);
    if (steps_ % window == 0) review_floor();
  }
}

bool relax(Increment& increment, double tolerance, long max_steps, History history,
           RelaxationMemory& memory) {
  return Relaxation(increment, history, memory).run(tolerance, max_steps);
}

}  // namespace grainlaw
