#include "contact/disc_half_contact_loops.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

using namespace disc_half_contacts;

#define GRAINLAW_RELINEARISATIONS(Real)                                        \
  GRAINLAW_BY_LANES(Relinearised, relinearise_locked_near, relinearise_loop,   \
                    (const Relinearisation<Real>& loop), (loop), false, false) \
  GRAINLAW_BY_LANES(Relinearised, relinearise_locked_far, relinearise_loop,    \
                    (const Relinearisation<Real>& loop), (loop), false, true)  \
  GRAINLAW_BY_LANES(Relinearised, relinearise_near, relinearise_loop,          \
                    (const Relinearisation<Real>& loop), (loop), true, false)  \
  GRAINLAW_BY_LANES(Relinearised, relinearise_far, relinearise_loop,           \
                    (const Relinearisation<Real>& loop), (loop), true, true)
GRAINLAW_RELINEARISATIONS(double)
GRAINLAW_RELINEARISATIONS(float)
GRAINLAW_STEP_LOOPS(2, double)
GRAINLAW_STEP_LOOPS(2, float)

}  // namespace

GRAINLAW_TAKE_STEP(2, double)
GRAINLAW_TAKE_STEP(2, float)

template <>
ContactTotals HalfContacts<2>::relinearise(std::span<const ParticleRecord<2>> particles,
                                           const ContactLaw& law, double factor,
                                           ContactList<2>& list) {
  for (std::size_t p = 0; p < particles_; ++p) positions_[slots_.slot(p)] = particles[p];
  const auto found = with_steps([&]<class Real>(Steps<Real>& steps) {
    restart(steps);
    const Relinearisation<Real> loop{.groups = slots_.groups(),
                                     .bounds = bounds_.data(),
                                     .starts = starts_.data(),
                                     .positions = &positions_[0].x,
                                     .nodes = steps.nodes.data(),
                                     .half_contacts = steps.half_contacts.data(),
                                     .ratio = law.ratio,
                                     .factor = factor,
                                     .per_stiffness = 1 / steps.stiffness,
                                     .per_force = 1 / (steps.stiffness * steps.length)};
    if (!list.rotates_far) {
      const auto near = law.rotating() ? relinearise_near(loop) : relinearise_locked_near(loop);
      list.rotates_far = near.beyond > 0;
      if (!list.rotates_far) return near;
    }
    return law.rotating() ? relinearise_far(loop) : relinearise_locked_far(loop);
  });
  // Half contacts count every contact twice.
  return {0.5 * found.force, 0.5 * found.touching, static_cast<int>(0.5 * found.touching)};
}

template <>
void HalfContacts<2>::displace(std::span<ParticleRecord<2>> particles) const {
  with_steps([&](const auto& steps) {
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const auto& displacement = steps.displacements[slots_.slot(p)];
      for (std::size_t c = 0; c < components; ++c) {
        component(particles[p], c) += steps.length * displacement.component[c];
      }
    }
  });
}

}  // namespace grainlaw::core
