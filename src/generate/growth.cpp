#include "generate/growth.hpp"

#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainlaw::core {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Collisions per particle between two rescalings of the velocities.
constexpr long collisions_per_block = 20;
// Reduced pressure of a jammed packing: gaps are about a diameter over it.
constexpr double jammed_pressure = 1e4;
constexpr long most_collisions_per_particle = 200000;

template <int D>
Vec<D> unit_vector(std::mt19937_64& engine) {
  const double angle = 2 * std::numbers::pi * unit_double(engine);
  if constexpr (D == 2) {
    return {std::cos(angle), std::sin(angle)};
  } else {
    const double z = 2 * unit_double(engine) - 1;
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }
}

}  // namespace

template <int D>
std::size_t Growth<D>::bucket(const Cells& cell) const {
  std::size_t index = 0;
  for (std::size_t k = dim; k-- > 0;) {
    const std::int32_t wrapped = (cell[k] % cells_ + cells_) % cells_;
    index = static_cast<std::size_t>(cells_) * index + static_cast<std::size_t>(wrapped);
  }
  return index;
}

template <int D>
Growth<D>::Growth(const GeneratorOptions& options, const std::vector<double>& radii) {
  const auto n = radii.size();
  double solid = 0;
  for (const double r : radii) solid += particle_size<D>(r);
  const double largest = *std::max_element(radii.begin(), radii.end());
  // Unit of radii that fill the box at scale 1.
  const double unit = 1 / edge_of<D>(solid);
  scale_ = edge_of<D>(start_fraction);
  end_scale_ = edge_of<D>(options.growth_end > 0 ? options.growth_end : 1);
  if (2 * largest * unit * end_scale_ > 1) end_scale_ = 1 / (2 * largest * unit);
  cells_ = std::max(1, static_cast<std::int32_t>(1 / (2 * largest * unit * end_scale_)));
  Cells last;
  last.fill(cells_ - 1);
  members_.resize(bucket(last) + 1);
  double mean = 0;
  for (const double r : radii) mean += r * unit / static_cast<double>(n);
  rate_ = options.growth_rate / mean;  // the thermal speed is 1
  for (const double r : radii) particles_.push_back({{}, {}, r * unit, 0, {}});
}

template <int D>
void Growth<D>::begin(const Packing& start, std::mt19937_64& engine) {
  const std::size_t n = particles_.size();
  const double side = start.cell[0];
  for (std::size_t p = 0; p < n; ++p) {
    Particle& particle = particles_[p];
    for (std::size_t k = 0; k < dim; ++k) particle.position[k] = start.position[k * n + p] / side;
    particle.velocity = unit_vector<D>(engine);
  }
  rescale();
}

template <int D>
bool Growth<D>::run() {
  const auto n = static_cast<long>(particles_.size());
  const long block = collisions_per_block * n;
  for (long done = 0; done < most_collisions_per_particle * n; done += block) {
    const bool ended = run_block(block);
    const double pressure = reduced_pressure();
    rescale();
    if (ended) return false;
    if (pressure > jammed_pressure) return true;
  }
  return true;
}

template <int D>
double Growth<D>::free_scale() const {
  double scale = scale_;
  for (std::size_t i = 0; i < particles_.size(); ++i)
    for_neighbours(particles_[i], [&](std::size_t j, const Cells& shift) {
      if (i == j && shift == Cells{}) return;
      const Particle& a = particles_[i];
      const Particle& b = particles_[j];
      scale = std::min(scale, length<D>(branch_of(a, b, shift)) / (a.radius + b.radius));
    });
  return scale * (1 - 1e-12);
}

template <int D>
double Growth<D>::reduced_pressure() const {
  double energy = 0;
  for (const Particle& particle : particles_) energy += 0.5 * square<D>(particle.velocity);
  return now_ > 0 ? 1 + virial_ / (2 * energy * now_) : never;
}

template <int D>
void Growth<D>::rescale() {
  const auto n = static_cast<double>(particles_.size());
  Vec<D> drift{};
  for (Particle& particle : particles_) {
    bring_up(particle);
    for (std::size_t k = 0; k < dim; ++k) drift[k] += particle.velocity[k] / n;
  }
  double squares = 0;
  for (Particle& particle : particles_) {
    for (std::size_t k = 0; k < dim; ++k) particle.velocity[k] -= drift[k];
    squares += square<D>(particle.velocity) / n;
  }
  const double factor = 1 / std::sqrt(squares);
  scale_ += rate_ * now_;
  now_ = 0;
  for (auto& bucket_members : members_) bucket_members.clear();
  events_ = {};
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Particle& particle = particles_[i];
    particle.time = 0;
    for (std::size_t k = 0; k < dim; ++k) {
      particle.velocity[k] *= factor;
      particle.position[k] -= std::floor(particle.position[k]);
      particle.cell[k] =
          std::min(cells_ - 1,
                   static_cast<std::int32_t>(particle.position[k] * static_cast<double>(cells_)));
    }
    members_[bucket(particle.cell)].push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) predict(i);
}

template class Growth<2>;
template class Growth<3>;

}  // namespace grainlaw::core
