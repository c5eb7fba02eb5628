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
  double* residual;
  double* mass;
  double* gain;  // 1 / mass, and 0 where nothing moves
  std::size_t doubles;
};

struct Measured {
  double largest;    // component of the residual [N]
  double stiffness;  // sum v (r_previous - r)
  double inertia;    // sum v m v
};

GRAINLAW_CLONES Measured measure(const Nodes& nodes) {
  Record largest_force{};
  Record stiffness{};
  Record inertia{};
  for (std::size_t k = 0; k < nodes.doubles; k += width) {
    const Record r = load<4>(nodes.residual + k);
    const Record v = load<4>(nodes.velocity + k);
    largest_force = largest(largest_force, magnitude(r));
    stiffness += v * (load<4>(nodes.previous + k) - r);
    inertia += v * load<4>(nodes.mass + k) * v;
  }
  return {most(largest_force), sum(stiffness), sum(inertia)};
}

// v <- keep v + gain r / m, z <- z + v for the record of every node.
GRAINLAW_CLONES void step_nodes(const Nodes& nodes, double keep, double gain, double* z) {
  for (std::size_t k = 0; k < nodes.doubles; k += width) {
    const Record r = load<4>(nodes.residual + k);
    const Record v = keep * load<4>(nodes.velocity + k) + gain * r * load<4>(nodes.gain + k);
    store(nodes.velocity + k, v);
    store(nodes.previous + k, r);
    if (z != nullptr) store(z + k, load<4>(z + k) + v);
  }
}

// The increment's unknowns as records while it is being relaxed.
class Relaxation {
 public:
  Relaxation(Increment& increment, History history, RelaxationMemory& memory)
      : increment_(increment), history_(history), memory_(memory) {
    const std::size_t doubles = width * increment.nodes();
    for (auto* column : {&memory.velocity, &memory.previous, &memory.mass, &memory.gain}) {
      column->assign(doubles, 0.0);
    }
  }

  // Every mass_interval steps: masses, mean force and neighbours of the present coordinates.
  void refresh() {
    if (history_ == History::advancing) increment_.advance_history();
    increment_.keep_neighbours();
    increment_.refresh_masses();
    increment_.load_records();
    const auto m = increment_.nodes();
    const auto& space = *increment_.problem->space;
    const double* mass = increment_.mass.data();
    const bool rotating = increment_.problem->law->rotating();
    for (std::size_t q = 0; q < m; ++q) {
      const double radius = increment_.node_radius[q];
      const bool fixed = !space.identity && space.fixed[q];
      double* record = memory_.mass.data() + width * q;
      double* gain = memory_.gain.data() + width * q;
      record[0] = record[1] = mass[q];
      gain[0] = gain[1] = fixed ? 0 : 1 / mass[q];
      record[2] = rotating ? mass[2 * m + q] / (radius * radius) : 1;
      gain[2] = 1 / record[2];
      record[3] = 1;
    }
  }

  void update() {
    const auto& law = *increment_.problem->law;
    if (history_ == History::advancing) {
      increment_.dissipated +=
          advance_contacts(increment_.records, law, increment_.contacts, increment_.forces);
    } else {
      evaluate_contacts(increment_.records, law, increment_.contacts, increment_.forces);
    }
    increment_.hold_fixed(increment_.forces);
  }

  Measured measured() { return measure(nodes()); }

  void step(double damping) {
    const bool identity = increment_.problem->space->identity;
    double* z = &increment_.records[0].x;
    step_nodes(nodes(), (2 - damping) / (2 + damping), 2 / (2 + damping), identity ? z : nullptr);
    if (identity) return;
    const auto& node = increment_.problem->space->node;
    for (std::size_t p = 0; p < increment_.particles(); ++p) {
      const double* v = memory_.velocity.data() + width * static_cast<std::size_t>(node[p]);
      store(z + width * p, load<4>(z + width * p) + load<4>(v));
    }
  }

 private:
  Nodes nodes() {
    return {memory_.velocity.data(),
            memory_.previous.data(),
            &increment_.forces[0].x,
            memory_.mass.data(),
            memory_.gain.data(),
            memory_.velocity.size()};
  }

  Increment& increment_;
  History history_;
  RelaxationMemory& memory_;
};

}  // namespace

bool relax(Increment& increment, double tolerance, long max_steps, History history,
           RelaxationMemory& memory) {
  constexpr double largest_damping = 1.9;
  constexpr double largest_floor = 0.5;
  constexpr long window = 100;             // steps after which the floor is reviewed
  constexpr double enough_progress = 0.5;  // of the residual, over a window
  constexpr double oscillating = 2;        // largest / smallest residual of a window
  Relaxation relaxation(increment, history, memory);

  double floor = 0.1;
  double window_start = std::numeric_limits<double>::infinity();
  double window_max = 0;
  double window_min = std::numeric_limits<double>::infinity();
  relaxation.refresh();
  relaxation.update();
  for (long step = 0;; ++step) {
    const auto now = relaxation.measured();
    double norm = std::numeric_limits<double>::infinity();
    if (increment.touching > 0 && std::isfinite(now.stiffness + now.largest)) {
      norm = now.largest / increment.relative_scale();
    }
    const bool over = norm < tolerance || step == max_steps || !std::isfinite(norm);
    if (over || (step % mass_interval == 0 && step > 0)) {
      increment.store_records();
      relaxation.refresh();
      if (over) {
        increment.update_forces();
        if (increment.residual_norm() < tolerance) return true;
        if (step == max_steps || !std::isfinite(norm)) return false;
      }
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
    const double inertia = std::max(now.inertia, std::numeric_limits<double>::min());
    const double damping =
        std::clamp(2 * std::sqrt(std::max(now.stiffness / inertia, 0.0)), floor, largest_damping);
    relaxation.step(damping);
    relaxation.update();
    ++increment.relaxation_steps;
  }
}

}  // namespace grainlaw
