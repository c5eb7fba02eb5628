// Energies of moving particles, and the part of the cross-sections' mean motion.

#include "contact/contact_point.hpp"
#include "dynamics/motion.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

// Assigns nodes to cross-sections by their position at rest, which keeps them there.
void WaveMotion::find_slices(double width, Slices& slices) const {
  const double left = specimen_->right_end() - specimen_->length;
  const auto last = static_cast<std::size_t>(specimen_->length / width) + 2;
  slices.of.resize(mass_.size());
  slices.mass.assign(last + 1, 0);
  for (std::size_t q = 0; q < mass_.size(); ++q) {
    const double x = specimen_->position[particle_of_[q]];
    const double slice = std::max((x - left) / width + 1, 0.0);
    slices.of[q] = static_cast<std::uint32_t>(std::min(static_cast<std::size_t>(slice), last));
    if (inverse_mass_[q].x > 0) slices.mass[slices.of[q]] += mass_[q];
  }
}

// Adds velocities at the present positions, with `half_step` half a time step; 0: as stored.
void WaveMotion::add_to_slices(double half_step, Slices& slices) const {
  slices.velocity.assign(slices.mass.size(), {});
  for (std::size_t q = 0; q < mass_.size(); ++q) {
    const auto& w = inverse_mass_[q];
    if (w.x == 0) continue;
    const auto& v = velocity_[q];
    const auto& f = forces_[q];
    auto& mean = slices.velocity[slices.of[q]];
    const double share = mass_[q] / slices.mass[slices.of[q]];
    mean[0] += share * (v.x + half_step * w.x * f.x);
    mean[1] += share * (v.y + half_step * w.y * f.y);
  }
}

void WaveMotion::damp_agitation() {
  if (slices_.of.empty()) find_slices(damping_.slice, slices_);
  add_to_slices(0, slices_);
  const double share = 1 - std::exp(-damping_.rate * time_step_);
  double lost = 0;
  for (std::size_t q = 0; q < mass_.size(); ++q) {
    const auto& w = inverse_mass_[q];
    if (w.x == 0) continue;
    auto& v = velocity_[q];
    const auto& mean = slices_.velocity[slices_.of[q]];
    const auto damp = [&](double& velocity, double to, double inertia) {
      const double after = velocity + share * (to - velocity);
      lost += 0.5 * inertia * (velocity * velocity - after * after);
      velocity = after;
    };
    damp(v.x, mean[0], mass_[q]);
    if (w.y > 0) damp(v.y, mean[1], mass_[q]);
    if (w.roll > 0) damp(v.roll, 0, 0.5 * mass_[q]);
  }
  dissipated_ += lost;
}

WaveEnergy WaveMotion::energy(double slice) const {
  WaveEnergy energy;
  energy.work = work_;
  energy.dissipated = dissipated_;
  energy.stored = stored_energy(list_, coordinates(), particles_.size(), law_);
  for (std::size_t q = 0; q < mass_.size(); ++q) {
    // The product of velocities half a step before and after the positions is conserved.
    const auto& v = velocity_[q];
    const auto& f = forces_[q];
    const auto& w = inverse_mass_[q];
    const double dt = time_step_, m = mass_[q];
    if (w.x > 0) energy.kinetic += 0.5 * m * v.x * (v.x + dt * w.x * f.x);
    if (w.y > 0) energy.kinetic += 0.5 * m * v.y * (v.y + dt * w.y * f.y);
    if (w.roll > 0) energy.kinetic += 0.25 * m * v.roll * (v.roll + dt * w.roll * f.roll);
  }
  Slices slices;
  find_slices(slice, slices);
  add_to_slices(0.5 * time_step_, slices);
  for (std::size_t k = 0; k < slices.mass.size(); ++k) {
    const auto& [x, y] = slices.velocity[k];
    energy.coherent += 0.5 * slices.mass[k] * (x * x + y * y);
  }
  return energy;
}

}  // namespace grainlaw::core
