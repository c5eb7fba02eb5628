#include "contact/sphere_half_contact_loops.hpp"

#include "base/capacity.hpp"
#include "base/constants.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

using namespace sphere_half_contacts;

#define GRAINLAW_RELINEARISATIONS(Real)                                   \
  GRAINLAW_BY_LANES(Relinearised, relinearise_locked, relinearise_loop,   \
                    (const Relinearisation<Real>& loop), (loop), false)   \
  GRAINLAW_BY_LANES(Relinearised, relinearise_rotating, relinearise_loop, \
                    (const Relinearisation<Real>& loop), (loop), true)
GRAINLAW_RELINEARISATIONS(double)
GRAINLAW_RELINEARISATIONS(float)
GRAINLAW_STEP_LOOPS(3, double)
GRAINLAW_STEP_LOOPS(3, float)

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

}  // namespace

GRAINLAW_TAKE_STEP(3, double)
GRAINLAW_TAKE_STEP(3, float)

// Finds the contacts that touch or that a move as large as an overlap may close.
template <>
void HalfContacts<3>::find_near(const ContactList<3>& list,
                                std::span<const ParticleRecord<3>> particles) {
  resize_with_capacity(overlap_, list.size());
  double overlaps = 0;
  std::size_t touching = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    double square = 0;
    for (std::size_t m = 0; m < 3; ++m) {
      const double l = component(particles[at(list.j[c])], m) -
                       component(particles[at(list.i[c])], m) + list.offset[m][c];
      square += l * l;
    }
    overlap_[c] = list.reach[c] - std::sqrt(square);
    if (overlap_[c] <= 0) continue;
    overlaps += overlap_[c];
    ++touching;
  }
  mean_overlap_ = touching > 0 ? overlaps / static_cast<double>(touching) : 0;
  resize_with_capacity(near_, list.size());
  for (std::size_t c = 0; c < list.size(); ++c) near_[c] = overlap_[c] > -mean_overlap_ ? 1 : 0;
}

template <>
ContactTotals HalfContacts<3>::relinearise(std::span<const ParticleRecord<3>> particles,
                                           const ContactLaw& law, double factor,
                                           ContactList<3>& /*list*/) {
  for (std::size_t p = 0; p < particles_; ++p) positions_[slots_.slot(p)] = particles[p];
  measure_moves();
  resize_with_capacity(near_rows_, slots_.groups().size());
  const auto found = with_steps([&]<class Real>(Steps<Real>& steps) {
    restart(steps);
    const Relinearisation<Real> loop{.groups = slots_.groups(),
                                     .bounds = bounds_.data(),
                                     .starts = starts_.data(),
                                     .positions = &positions_[0].x,
                                     .nodes = steps.nodes.data(),
                                     .half_contacts = steps.half_contacts.data(),
                                     .near_rows = near_rows_.data(),
                                     .ratio = law.ratio,
                                     .factor = factor,
                                     .margin = mean_overlap_ + tuned::near_moves * moved_,
                                     .per_stiffness = 1 / steps.stiffness,
                                     .per_force = 1 / (steps.stiffness * steps.length)};
    return law.rotating() ? relinearise_rotating(loop) : relinearise_locked(loop);
  });
  // Half contacts count every contact twice.
  const ContactTotals totals{0.5 * found.force, 0.5 * found.touching,
                             static_cast<int>(0.5 * found.touching)};
  if (totals.touching > 0) mean_overlap_ = totals.force / (totals.weights * mean_stiffness_);
  return totals;
}

template <>
void HalfContacts<3>::displace(std::span<ParticleRecord<3>> particles) const {
  with_steps([&](const auto& steps) {
    for (std::size_t p = 0; p < particles.size(); ++p) {
      ParticleRecord<3>& particle = particles[p];
      const auto& displacement = steps.displacements[slots_.slot(p)];
      double eta_square = 0;
      for (std::size_t c = 0; c < components; ++c) {
        double& value = component(particle, c);
        value += steps.length * displacement.component[c];
        if (c >= 3) eta_square += value * value;
      }
      particle.half = 0.5 / std::sqrt(1 + 0.25 * eta_square / (particle.radius * particle.radius));
    }
  });
}

}  // namespace grainlaw::core
