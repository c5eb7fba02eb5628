// Events of flying and growing particles: collisions, and entries into the next grid cell.
#include "generate/growth.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

template <int D>
double Growth<D>::meeting(const Particle& a, const Particle& b, const Cells& shift) const {
  const double late = now_ - b.time;
  Vec<D> x, u;
  for (std::size_t k = 0; k < dim; ++k) {
    x[k] = b.position[k] + b.velocity[k] * late + static_cast<double>(shift[k]) - a.position[k];
    u[k] = b.velocity[k] - a.velocity[k];
  }
  const double reach = a.radius + b.radius;
  const double size = reach * (scale_ + rate_ * now_);
  const double growth = reach * rate_;
  const double square = core::square<D>(u) - growth * growth;
  const double half = dot<D>(x.data(), u.data()) - size * growth;
  const double gap = core::square<D>(x) - size * size;
  if (gap <= 0 && half < 0) return 0;  // touching by rounding, and coming closer
  const double discriminant = half * half - square * gap;
  if (discriminant < 0) return never;
  const double root = std::sqrt(discriminant);
  if (gap > 0) return root > half ? gap / (root - half) : never;
  return square < 0 ? (-half - root) / square : never;
}

template <int D>
void Growth<D>::predict(std::size_t i) {
  const Particle& particle = particles_[i];
  Event next;
  next.particle = static_cast<int>(i);
  next.collisions = particle.collisions;
  const auto leaving = [&](double position, double velocity, std::int32_t cell) {
    const double width = 1 / static_cast<double>(cells_);
    const auto k = static_cast<double>(cell);
    if (velocity > 0) return ((k + 1) * width - position) / velocity;
    return velocity < 0 ? (k * width - position) / velocity : never;
  };
  double time = never;
  for (std::size_t k = 0; k < dim; ++k) {
    time = std::min(time, leaving(particle.position[k], particle.velocity[k], particle.cell[k]));
  }
  time = std::max(0.0, time);
  for_neighbours(particle, [&](std::size_t j, const Cells& shift) {
    if (i == j) return;  // no radius reaches its own image
    const double meet = meeting(particle, particles_[j], shift);
    if (meet >= time) return;
    time = meet;
    next.partner = static_cast<int>(j);
    next.shift = shift;
    next.partner_collisions = particles_[j].collisions;
  });
  next.time = now_ + time;
  events_.push(next);
}

template <int D>
void Growth<D>::bring_up(Particle& particle) const {
  for (std::size_t k = 0; k < dim; ++k) {
    particle.position[k] += particle.velocity[k] * (now_ - particle.time);
  }
  particle.time = now_;
}

// Elastic collision of equal masses in the frame of the growing surfaces.
template <int D>
void Growth<D>::collide(Particle& a, Particle& b, const Cells& shift) {
  Vec<D> normal = branch_of(a, b, shift);
  const double distance = length<D>(normal);
  for (double& component : normal) component /= distance;
  Vec<D> approach;
  for (std::size_t k = 0; k < dim; ++k) approach[k] = b.velocity[k] - a.velocity[k];
  const double growth = (a.radius + b.radius) * rate_;
  const double kick = growth - dot<D>(approach.data(), normal.data());
  for (std::size_t k = 0; k < dim; ++k) {
    a.velocity[k] -= kick * normal[k];
    b.velocity[k] += kick * normal[k];
  }
  ++a.collisions;
  ++b.collisions;
  virial_ += kick * distance;
}

// The cell follows from the position, limited to one cell per event against rounding at the wall.
template <int D>
void Growth<D>::enter_next_cell(std::size_t i) {
  Particle& particle = particles_[i];
  auto& left = members_[bucket(particle.cell)];
  left.erase(std::find(left.begin(), left.end(), static_cast<int>(i)));
  const double width = 1 / static_cast<double>(cells_);
  for (std::size_t k = 0; k < dim; ++k) {
    const double velocity = particle.velocity[k];
    std::int32_t& cell = particle.cell[k];
    const double wall = static_cast<double>(velocity > 0 ? cell + 1 : cell) * width;
    const double rest = velocity > 0 ? wall - particle.position[k] : particle.position[k] - wall;
    if (velocity != 0 && rest <= 1e-12 * width) cell += velocity > 0 ? 1 : -1;
  }
  members_[bucket(particle.cell)].push_back(static_cast<int>(i));
}

template <int D>
bool Growth<D>::run_block(long collisions) {
  const double end = (end_scale_ - scale_) / rate_;
  virial_ = 0;
  while (collisions > 0) {
    const Event event = events_.top();
    if (event.time >= end) {
      now_ = end;
      return true;
    }
    events_.pop();
    const auto i = static_cast<std::size_t>(event.particle);
    Particle& particle = particles_[i];
    if (event.collisions != particle.collisions) continue;
    now_ = event.time;
    bring_up(particle);
    if (event.partner < 0) {
      enter_next_cell(i);
      predict(i);
      continue;
    }
    const auto j = static_cast<std::size_t>(event.partner);
    Particle& partner = particles_[j];
    if (event.partner_collisions != partner.collisions) {
      predict(i);
      continue;
    }
    bring_up(partner);
    collide(particle, partner, event.shift);
    predict(i);
    predict(j);
    --collisions;
  }
  return false;
}

template class Growth<2>;
template class Growth<3>;

}  // namespace grainlaw::core
