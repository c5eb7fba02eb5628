#include "equilibrium/relaxation.hpp"

#include "base/constants.hpp"
#include "base/simd.hpp"
#include "equilibrium/node_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

using namespace simd;
using namespace node_step;

static_assert(tuned::long_interval % tuned::mass_interval<2> == 0);
static_assert(tuned::long_interval % tuned::mass_interval<3> == 0);
static_assert(tuned::extrapolation_interval % tuned::long_interval == 0);

GRAINLAW_CLONES void find_gains(const double* mass, double* gain, std::size_t doubles) {
  for (std::size_t k = 0; k < doubles; k += 4) store(gain + k, 1 / load<4>(mass + k));
}

}  // namespace

template <int D>
Relaxation<D>::Relaxation(Increment<D>& increment, History history, RelaxationMemory<D>& memory,
                          bool may_extrapolate)
    : increment_(increment),
      problem_(increment.problem()),
      motion_(increment.motion()),
      history_(history),
      memory_(memory) {
  const auto& law = *problem_.law;
  const bool by_places = history == History::committed && problem_.space->identity;
  by_half_contacts_ = by_places && law.plain() && law.tangential();
  fused_ = by_places && law.plain() && !by_half_contacts_;
  // Without friction there is no flutter, and the damping follows the softest mode.
  friction_noise_ = by_places && law.tangential();
  extrapolates_ = may_extrapolate && friction_noise_;
  if (extrapolates_) {
    memory.slow.reserve(problem_.particles());
    memory.slow.forget();
  }
  if (by_half_contacts_) return;
  for (auto* column : {&memory.velocity, &memory.gain}) {
    column->assign(width * increment.forces().size(), 0.0);
  }
}

// Updates masses, mean force and neighbours at the present coordinates.
template <int D>
void Relaxation<D>::refresh() {
  if (history_ == History::advancing) increment_.advance_history();
  const bool relisted = increment_.keep_neighbours();
  if (by_half_contacts_) {
    if (relisted || !arranged_) {
      memory_.half_contacts.arrange(increment_.contacts(), *problem_.packing,
                                    increment_.masses().least(), motion_.records(), at_rest_,
                                    memory_.single_precision);
      arranged_ = true;
      at_rest_ = false;
    }
    memory_.half_contacts.step_in_single_precision(memory_.single_precision &&
                                                   residual_ > tuned::single_precision);
    refresh_start_ = refresh_max_ = residual_;
    return increment_.relinearise(memory_.half_contacts);
  }
  increment_.sum_masses();
  find_gains(&increment_.masses().records()[0].x, memory_.gain.data(), memory_.gain.size());
  const auto& space = *problem_.space;
  if (space.identity) return;
  double* gain = memory_.gain.data();
  for (std::size_t q = 0; q < problem_.nodes(); ++q, gain += width) {
    for (std::size_t k = 0; k < Dimension<D>::unknowns; ++k) {
      if ((space.fixed[q] & fixed_bit(k)) != 0) gain[k] = 0;
    }
  }
  if (!space.finds_deformation) return;
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (!space.found[k]) gain[width * (k / D) + k % D] = 0;
  }
}

// True if the relinearisation may wait. Contacts hardly move, forces of those that switch are still
// right, and outdated masses would raise the residual.
template <int D>
bool Relaxation<D>::may_skip_refresh() const {
  return by_half_contacts_ && residual_ < tuned::skip_refresh_residual &&
         refresh_max_ < tuned::skip_refresh_rise * refresh_start_ &&
         steps_ % tuned::long_interval != 0;
}

template <int D>
void Relaxation<D>::update() {
  if (by_half_contacts_) return;  // step() finds the forces
  if (fused_) return increment_.find_contact_forces();
  increment_.find_forces(history_);
}

template <int D>
double Relaxation<D>::size() const {
  return std::max(1.0, static_cast<double>(problem_.nodes()) / tuned::usual_nodes);
}

// A high lower bound suppresses flutter; a low one lets soft modes move, which are softer in large
// packings.
template <int D>
void Relaxation<D>::review_floor() {
  if (residual_ > tuned::slow_window * window_start_) {
    const bool flutter = window_max_ > tuned::oscillating_window * window_min_;
    const double largest = std::max(tuned::first_floor, tuned::largest_floor / std::sqrt(size()));
    floor_ = flutter ? std::min(2 * floor_, largest) : 0.5 * floor_;
  }
  if (window_max_ < tuned::gaining_window * least_max_) {
    least_max_ = window_max_;
    last_gain_ = steps_;
  }
  window_start_ = window_max_ = window_min_ = residual_;
}

// True if friction flutters without end: some clusters have no stable equilibrium within reach.
template <int D>
bool Relaxation<D>::flutters() const {
  if (!friction_noise_ || window_max_ <= tuned::flutter_residual) return false;
  return static_cast<double>(steps_ - last_gain_) >
         tuned::flutter_patience * std::pow(size(), tuned::flutter_growth);
}

// Extrapolates where soft modes creep under the damping that flutter needs, and returns whether it
// did. Pauses grow, since the relaxation has to remove what an extrapolation disturbs.
template <int D>
bool Relaxation<D>::extrapolate() {
  if (steps_ % tuned::extrapolation_interval != 0) return false;
  const bool creeps =
      residual_ < tuned::extrapolation_residual && check_max_ < tuned::restless * check_min_;
  check_max_ = check_min_ = residual_;
  if (!creeps || steps_ < next_extrapolation_) {
    memory_.slow.forget();
    return false;
  }
  increment_.update_forces();
  memory_.slow.see(motion_.records(), increment_.forces(), residual_);
  if (!memory_.slow.slow()) return false;
  const double stiffness = increment_.masses().mean_stiffness();
  const double limit = tuned::longest_extrapolation * increment_.scale().relative() / stiffness;
  const bool extrapolated =
      memory_.slow.extrapolate(motion_.records(), limit, tuned::least_stiffness * stiffness);
  memory_.slow.forget();
  if (!extrapolated) return false;
  pause_ = tuned::longer_pause * pause_ + tuned::extrapolation_interval;
  next_extrapolation_ = steps_ + std::lround(pause_);
  motion_.store_records();
  std::fill(memory_.velocity.begin(), memory_.velocity.end(), 0.0);
  arranged_ = false;
  at_rest_ = true;
  power_ = frequency_ = 0;
  return true;
}

// Takes one step with the damping that the last step measured.
template <int D>
void Relaxation<D>::step() {
  const double damping = std::clamp(2 * frequency_, floor_, tuned::largest_damping);
  const double keep = (2 - damping) / (2 + damping);
  const double gain = 2 / (2 + damping);
  const auto before = one_step(keep, gain);
  const double stiffness = power_ - before.power;  // sum v (r_previous - r)
  power_ = before.next_power;
  residual_ = std::numeric_limits<double>::infinity();
  if (increment_.held() && std::isfinite(stiffness + before.largest)) {
    residual_ = before.largest / increment_.scale().relative();
  }
  const double inertia = std::max(before.inertia, std::numeric_limits<double>::min());
  frequency_ = std::sqrt(std::max(stiffness / inertia, 0.0));
  ++steps_;
  ++increment_.cost.relaxation_steps;
}

template <int D>
auto Relaxation<D>::one_step(double keep, double gain) -> Measured {
  if (by_half_contacts_) return memory_.half_contacts.step(*problem_.law, keep, gain);
  return step_nodes(keep, gain);
}

template <int D>
auto Relaxation<D>::step_nodes(double keep, double gain) -> Measured {
  const auto& space = *problem_.space;
  double* z = &motion_.records()[0].x;
  const Nodes nodes{memory_.velocity.data(), &increment_.masses().records()[0].x,
                    memory_.gain.data(), space.identity ? z : nullptr};
  if (fused_) {
    const auto drag = motion_.drag().of_nodes();
    return gather_and_step(nodes, increment_.contacts(), drag, keep, gain);
  }
  const auto before = step_all(nodes, increment_.forces(), keep, gain);
  if (space.identity) return before;
  if (space.finds_deformation) step_deformation();
  for (std::size_t p = 0; p < problem_.particles(); ++p) {
    const double* v = memory_.velocity.data() + width * static_cast<std::size_t>(space.node[p]);
    store(z + width * p, load<width>(z + width * p) + load<width>(v));
  }
  return before;
}

// Changes the found components of F along with the nodes, by a limited length per step.
template <int D>
void Relaxation<D>::step_deformation() {
  const double limit = tuned::largest_deformation_step * motion_.deformation_scale();
  double* v = memory_.velocity.data() + width * problem_.nodes();
  for (std::size_t k = 0; k < D * width; ++k) v[k] = std::clamp(v[k], -limit, limit);
  motion_.change_deformation(v);
}

template <int D>
bool Relaxation<D>::run(double tolerance, long steps, double least_force) {
  motion_.load_records();
  arranged_ = false;
  if (by_half_contacts_ && memory_.single_precision) {
    increment_.keep_neighbours();
    increment_.update_forces();
    residual_ = increment_.residual_norm();
    if (residual_ < tolerance) return true;
    refresh();
  } else {
    refresh();
    increment_.update_forces();
    if (increment_.residual_norm() < tolerance) return true;
  }
  for (const long last = steps_ + steps;;) {
    step();
    const bool stop =
        steps_ == last || !std::isfinite(residual_) ||
        (steps_ % tuned::floor_window == 0 &&
         (increment_.scale().mean_force() < least_force || flutters() || increment_.runs_away()));
    const bool over = residual_ < tolerance || stop;
    if (over || (steps_ % tuned::mass_interval<D> == 0 && !may_skip_refresh())) {
      if (by_half_contacts_) memory_.half_contacts.displace(motion_.records());
      motion_.store_records();
      refresh();
      if (extrapolates_ && !over && extrapolate()) refresh();
    }
    update();
    if (over) {
      increment_.update_forces();
      if (increment_.residual_norm() < tolerance) return true;
      if (stop) return false;
    }
    refresh_max_ = std::max(refresh_max_, residual_);
    check_max_ = std::max(check_max_, residual_);
    check_min_ = std::min(check_min_, residual_);
    window_max_ = std::max(window_max_, residual_);
    window_min_ = std::min(window_min_, residual_);
    if (steps_ % tuned::floor_window == 0) review_floor();
  }
}

template <int D>
bool relax(Increment<D>& increment, double tolerance, long max_steps, History history,
           RelaxationMemory<D>& memory, double least_force, bool may_extrapolate) {
  return Relaxation<D>(increment, history, memory, may_extrapolate)
      .run(tolerance, max_steps, least_force);
}

template class Relaxation<2>;
template class Relaxation<3>;
template bool relax(Increment<2>&, double, long, History, RelaxationMemory<2>&, double, bool);
template bool relax(Increment<3>&, double, long, History, RelaxationMemory<3>&, double, bool);

}  // namespace grainlaw::core
