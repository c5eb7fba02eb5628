#include "contact/sphere_half_contact_loops.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

using namespace sphere_half_contacts;

#define GRAINLAW_HALF_CONTACT_LOOP(Result, name, loop_of, ...) \
  GRAINLAW_BY_LANES(Result, name, loop_of, (const HalfContactLoop& loop), (loop), __VA_ARGS__)
GRAINLAW_HALF_CONTACT_LOOP(Relinearised, relinearise_locked, relinearise_loop, false)
GRAINLAW_HALF_CONTACT_LOOP(Relinearised, relinearise_rotating, relinearise_loop, true)
GRAINLAW_HALF_CONTACT_LOOP(StepMeasures, step_locked, step_loop, false, false)
GRAINLAW_HALF_CONTACT_LOOP(StepMeasures, step_locked_dragged, step_loop, false, true)
GRAINLAW_HALF_CONTACT_LOOP(StepMeasures, step_rotating, step_loop, true, false)
GRAINLAW_HALF_CONTACT_LOOP(StepMeasures, step_rotating_dragged, step_loop, true, true)

}  // namespace

template <>
auto HalfContacts<3>::velocity(std::size_t particle) const -> Velocity {
  const std::size_t slot = slots_.slot(particle);
  Velocity result{};
  for (std::size_t c = 0; c < components; ++c) {
    result[c] = nodes_[slot / lanes].velocity[c][slot % lanes];
  }
  return result;
}

template <>
void HalfContacts<3>::set_velocity(std::size_t particle, const Velocity& velocity) {
  const std::size_t slot = slots_.slot(particle);
  for (std::size_t c = 0; c < components; ++c) {
    nodes_[slot / lanes].velocity[c][slot % lanes] = velocity[c];
  }
}

template <>
ContactTotals HalfContacts<3>::relinearise(std::span<const ParticleRecord<3>> particles,
                                           const ContactLaw& law, double factor,
                                           ContactList<3>& /*list*/) {
  for (std::size_t p = 0; p < particles_; ++p) positions_[slots_.slot(p)] = particles[p];
  for (Nodes& nodes : nodes_) std::fill_n(nodes.moved[0], components * lanes, 0.0);
  std::fill(displacements_.begin(), displacements_.end(), ParticleRecord<3>{});
  const HalfContactLoop loop{.groups = slots_.groups(),
                             .nodes = nodes_.data(),
                             .bounds = bounds_.data(),
                             .starts = starts_.data(),
                             .half_contacts = half_contacts_.data(),
                             .records = &positions_[0].x,
                             .ratio = law.ratio,
                             .factor = factor};
  const Relinearised found = law.rotating() ? relinearise_rotating(loop) : relinearise_locked(loop);
  drags_.clear();
  // Half contacts count every contact twice.
  return {0.5 * found.force, 0.5 * found.touching, static_cast<int>(0.5 * found.touching)};
}

template <>
StepMeasures HalfContacts<3>::step(const ContactLaw& law, double keep, double gain) {
  const HalfContactLoop loop{.groups = slots_.groups(),
                             .nodes = nodes_.data(),
                             .bounds = nullptr,
                             .drags = drags_.data(),
                             .starts = nullptr,
                             .half_contacts = half_contacts_.data(),
                             .records = &displacements_[0].x,
                             .next_displacements = &last_displacements_[0].x,
                             .friction = law.friction,
                             .ratio = law.ratio,
                             .keep = keep,
                             .gain = gain};
  const auto stepped = [&] {
    if (drags_.empty()) return law.rotating() ? step_rotating(loop) : step_locked(loop);
    return law.rotating() ? step_rotating_dragged(loop) : step_locked_dragged(loop);
  };
  const StepMeasures measures = stepped();
  displacements_.swap(last_displacements_);
  return measures;
}

template <>
void HalfContacts<3>::displace(std::span<ParticleRecord<3>> particles) const {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    ParticleRecord<3>& particle = particles[p];
    const ParticleRecord<3>& displacement = displacements_[slots_.slot(p)];
    double eta_square = 0;
    for (std::size_t c = 0; c < components; ++c) {
      double& value = component(particle, c);
      value += component(displacement, c);
      if (c >= 3) eta_square += value * value;
    }
    particle.half = 0.5 / std::sqrt(1 + 0.25 * eta_square / (particle.radius * particle.radius));
  }
}

}  // namespace grainlaw::core
