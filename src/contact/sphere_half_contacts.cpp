#include "contact/sphere_half_contact_loops.hpp"

#include "base/capacity.hpp"
#include "base/constants.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

using namespace sphere_half_contacts;

#define GRAINLAW_HALF_CONTACT_LOOPS(Real)                                                          \
  GRAINLAW_BY_LANES(Relinearised, relinearise_locked, relinearise_loop,                            \
                    (const Relinearisation<Real>& loop), (loop), false)                            \
  GRAINLAW_BY_LANES(Relinearised, relinearise_rotating, relinearise_loop,                          \
                    (const Relinearisation<Real>& loop), (loop), true)                             \
  GRAINLAW_BY_LANES(StepMeasures, step_locked, step_loop, (const Step<Real>& loop), (loop), false, \
                    false)                                                                         \
  GRAINLAW_BY_LANES(StepMeasures, step_locked_dragged, step_loop, (const Step<Real>& loop),        \
                    (loop), false, true)                                                           \
  GRAINLAW_BY_LANES(StepMeasures, step_rotating, step_loop, (const Step<Real>& loop), (loop),      \
                    true, false)                                                                   \
  GRAINLAW_BY_LANES(StepMeasures, step_rotating_dragged, step_loop, (const Step<Real>& loop),      \
                    (loop), true, true)
GRAINLAW_HALF_CONTACT_LOOPS(double)
GRAINLAW_HALF_CONTACT_LOOPS(float)

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

// Power of two that is at most this number, so that units do not round.
double power_of_two(double number) { return std::ldexp(1.0, std::ilogb(number)); }

}  // namespace

template <>
auto HalfContacts<3>::velocity(std::size_t particle) const -> Velocity {
  const std::size_t slot = slots_.slot(particle);
  Velocity result{};
  with_steps([&](const auto& steps) {
    for (std::size_t c = 0; c < components; ++c) {
      result[c] = steps.length * steps.nodes[slot / lanes].velocity[c][slot % lanes];
    }
  });
  return result;
}

template <>
void HalfContacts<3>::set_velocity(std::size_t particle, const Velocity& velocity) {
  const std::size_t slot = slots_.slot(particle);
  with_steps([&]<class Real>(Steps<Real>& steps) {
    for (std::size_t c = 0; c < components; ++c) {
      steps.nodes[slot / lanes].velocity[c][slot % lanes] =
          static_cast<Real>(velocity[c] / steps.length);
    }
  });
}

// Updates the largest displacement if there is one.
template <>
void HalfContacts<3>::measure_moves() {
  with_steps([this]<class Real>(const Steps<Real>& steps) {
    Real largest = 0;
    for (const auto& nodes : steps.nodes) {
      for (const auto& moved : nodes.moved) {
        for (const Real value : moved) largest = std::max(largest, std::abs(value));
      }
    }
    if (largest > 0) moved_ = steps.length * static_cast<double>(largest);
  });
}

template <>
void HalfContacts<3>::step_in_single_precision(bool single) {
  if (single == single_precision_) return;
  measure_moves();
  const auto carry = []<class From, class To>(const Steps<From>& from, Steps<To>& to) {
    for (std::size_t g = 0; g < from.nodes.size(); ++g) {
      for (std::size_t c = 0; c < components; ++c) {
        const auto& velocity = from.nodes[g].velocity[c];
        std::transform(velocity, velocity + lanes, to.nodes[g].velocity[c], [&](From value) {
          return static_cast<To>(value * (from.length / to.length));
        });
        std::fill_n(to.nodes[g].moved[c], lanes, To(0));
      }
    }
  };
  if (single) {
    carry(steps_, single_);
  } else {
    carry(single_, steps_);
  }
  single_precision_ = single;
}

// Finds the contacts that touch or that a move as large as an overlap may close.
template <>
void HalfContacts<3>::find_near(const ContactList<3>& list,
                                std::span<const ParticleRecord<3>> particles) {
  resize_with_capacity(overlap_, list.size());
  double overlaps = 0;
  double stiffness = 0;
  std::size_t touching = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    double square = 0;
    for (std::size_t m = 0; m < 3; ++m) {
      const double l = component(particles[at(list.j[c])], m) -
                       component(particles[at(list.i[c])], m) + list.offset[m][c];
      square += l * l;
    }
    overlap_[c] = list.reach[c] - std::sqrt(square);
    stiffness += list.normal_stiffness[c];
    if (overlap_[c] <= 0) continue;
    overlaps += overlap_[c];
    ++touching;
  }
  mean_overlap_ = touching > 0 ? overlaps / static_cast<double>(touching) : 0;
  resize_with_capacity(near_, list.size());
  for (std::size_t c = 0; c < list.size(); ++c) near_[c] = overlap_[c] > -mean_overlap_ ? 1 : 0;
  mean_stiffness_ = list.size() > 0 ? stiffness / static_cast<double>(list.size()) : 1;
  single_.length = power_of_two(0.5 / curvature_);
  single_.stiffness = power_of_two(mean_stiffness_);
}

template <>
ContactTotals HalfContacts<3>::relinearise(std::span<const ParticleRecord<3>> particles,
                                           const ContactLaw& law, double factor,
                                           ContactList<3>& /*list*/) {
  for (std::size_t p = 0; p < particles_; ++p) positions_[slots_.slot(p)] = particles[p];
  measure_moves();
  resize_with_capacity(near_rows_, slots_.groups().size());
  const auto found = with_steps([&]<class Real>(Steps<Real>& steps) {
    for (auto& nodes : steps.nodes) std::fill_n(nodes.moved[0], components * lanes, Real(0));
    std::fill(steps.displacements.begin(), steps.displacements.end(), SphereDisplacement<Real>{});
    steps.drags.clear();
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
StepMeasures HalfContacts<3>::step(const ContactLaw& law, double keep, double gain) {
  return with_steps([&]<class Real>(Steps<Real>& steps) {
    const sphere_half_contacts::Step<Real> loop{
        .groups = near_rows_,
        .drags = steps.drags.data(),
        .half_contacts = steps.half_contacts.data(),
        .nodes = steps.nodes.data(),
        .displacements = steps.displacements[0].component,
        .next_displacements = steps.last_displacements[0].component,
        .friction = static_cast<Real>(law.friction),
        .ratio = static_cast<Real>(law.ratio),
        .keep = static_cast<Real>(keep),
        .gain = static_cast<Real>(gain)};
    const auto stepped = [&] {
      if (steps.drags.empty()) return law.rotating() ? step_rotating(loop) : step_locked(loop);
      return law.rotating() ? step_rotating_dragged(loop) : step_locked_dragged(loop);
    };
    const StepMeasures measures = stepped();
    steps.displacements.swap(steps.last_displacements);
    const double force = steps.stiffness * steps.length;
    const double energy = force * steps.length;
    return StepMeasures{force * measures.largest, energy * measures.power,
                        energy * measures.next_power, energy * measures.inertia};
  });
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
