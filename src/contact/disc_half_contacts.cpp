#include "contact/disc_half_contact_loops.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

using namespace disc_half_contacts;

GRAINLAW_LOOP(Relinearised, relinearise_locked_near, relinearise_loop, false, false)
GRAINLAW_LOOP(Relinearised, relinearise_locked_far, relinearise_loop, false, true)
GRAINLAW_LOOP(Relinearised, relinearise_near, relinearise_loop, true, false)
GRAINLAW_LOOP(Relinearised, relinearise_far, relinearise_loop, true, true)
GRAINLAW_LOOP(StepMeasures, step_locked, step_loop, false, false)
GRAINLAW_LOOP(StepMeasures, step_locked_dragged, step_loop, false, true)
GRAINLAW_LOOP(StepMeasures, step_rotating, step_loop, true, false)
GRAINLAW_LOOP(StepMeasures, step_rotating_dragged, step_loop, true, true)

}  // namespace

// A velocity is the displacement of the last step.
template <>
auto HalfContacts<2>::velocity(std::size_t particle) const -> Velocity {
  const ParticleRecord<2>& now = steps_.displacements[slots_.slot(particle)];
  const ParticleRecord<2>& last = steps_.last_displacements[slots_.slot(particle)];
  return {now.x - last.x, now.y - last.y, now.roll - last.roll};
}

template <>
void HalfContacts<2>::set_velocity(std::size_t particle, const Velocity& velocity) {
  steps_.last_displacements[slots_.slot(particle)] = {-velocity[0], -velocity[1], -velocity[2], 0};
}

template <>
ContactTotals HalfContacts<2>::relinearise(std::span<const ParticleRecord<2>> particles,
                                           const ContactLaw& law, double factor,
                                           ContactList<2>& list) {
  for (std::size_t p = 0; p < particles_; ++p) positions_[slots_.slot(p)] = particles[p];
  for (std::size_t s = 0; s < steps_.displacements.size(); ++s) {
    const ParticleRecord<2>& now = steps_.displacements[s];
    ParticleRecord<2>& last = steps_.last_displacements[s];
    last = {last.x - now.x, last.y - now.y, last.roll - now.roll, 0};
  }
  std::fill(steps_.displacements.begin(), steps_.displacements.end(), ParticleRecord<2>{});
  const Loop loop{.groups = slots_.groups(),
                  .nodes = steps_.nodes.data(),
                  .bounds = bounds_.data(),
                  .starts = starts_.data(),
                  .half_contacts = steps_.half_contacts.data(),
                  .records = &positions_[0].x,
                  .ratio = law.ratio,
                  .factor = factor};
  Relinearised found{};
  if (!list.rotates_far) {
    found = law.rotating() ? relinearise_near(loop) : relinearise_locked_near(loop);
    list.rotates_far = found.beyond > 0;
  }
  if (list.rotates_far) {
    found = law.rotating() ? relinearise_far(loop) : relinearise_locked_far(loop);
  }
  steps_.drags.clear();
  // Half contacts count every contact twice.
  return {0.5 * found.force, 0.5 * found.touching, static_cast<int>(0.5 * found.touching)};
}

template <>
StepMeasures HalfContacts<2>::step(const ContactLaw& law, double keep, double gain) {
  const Loop loop{.groups = slots_.groups(),
                  .nodes = steps_.nodes.data(),
                  .bounds = nullptr,
                  .drags = steps_.drags.data(),
                  .starts = nullptr,
                  .half_contacts = steps_.half_contacts.data(),
                  .records = &steps_.displacements[0].x,
                  .last_displacements = &steps_.last_displacements[0].x,
                  .curvature = curvature_,
                  .friction = law.friction,
                  .ratio = law.ratio,
                  .keep = keep,
                  .gain = gain};
  const auto stepped = [&] {
    if (steps_.drags.empty()) return law.rotating() ? step_rotating(loop) : step_locked(loop);
    return law.rotating() ? step_rotating_dragged(loop) : step_locked_dragged(loop);
  };
  const StepMeasures measures = stepped();
  steps_.displacements.swap(steps_.last_displacements);
  return measures;
}

template <>
void HalfContacts<2>::displace(std::span<ParticleRecord<2>> particles) const {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const ParticleRecord<2>& displacement = steps_.displacements[slots_.slot(p)];
    particles[p].x += displacement.x;
    particles[p].y += displacement.y;
    particles[p].roll += displacement.roll;
  }
}

}  // namespace grainlaw::core
