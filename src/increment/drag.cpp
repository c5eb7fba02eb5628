#include "increment/drag.hpp"

#include "base/capacity.hpp"
#include "base/simd.hpp"
#include "frame/average_masses.hpp"
#include "increment/records.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

template <int D>
using Record = simd::Lanes<Dimension<D>::lanes>;

template <int D, class Struct>
Record<D> load(const Struct& record) {
  return simd::load<Dimension<D>::lanes>(&record.x);
}

// Share of the stiffness of one contact; 0 for rotations of particles without rotation.
MassRecord<2> stiffness_of(const LeastMass<2>& least, double share, bool rotating) {
  return {share * least.x, share * least.y, rotating ? share * least.roll : 0, 0};
}
MassRecord<3> stiffness_of(const LeastMass<3>& least, double share, bool rotating) {
  const double x = share * least.x;
  const double spin = rotating ? share * least.spin : 0;
  return {x, x, x, spin, spin, spin, {0, 0}};
}

// Factor x the mass, without rotations likewise.
template <class Mass>
Mass stiffness_of(Mass mass, double factor, bool rotating) {
  constexpr std::size_t unknowns = components_of<Mass>.size();
  constexpr std::size_t translations = unknowns / 2 + unknowns % 2;
  for (std::size_t k = 0; k < unknowns; ++k) {
    component(mass, k) *= k < translations || rotating ? factor : 0;
  }
  return mass;
}

}  // namespace

template <int D>
void Drag<D>::begin(const DragStart<D>& how, const BoundarySpace<D>& space, bool rotating,
                    std::span<const LeastMass<D>> least, std::span<const MassRecord<D>> mass,
                    const std::vector<double>& start, const Tensor<D>& from,
                    const Tensor<D>& stretch, std::span<const double> affine,
                    std::span<const double> velocity) {
  how_ = how;
  in_part_ = true;
  from_ = from;
  copy_with_capacity(start, part_start_);
  const std::size_t n = space.node.size();
  const std::size_t nodes = space.nodes;
  resize_with_capacity(particle_, nodes);
  for (std::size_t p = 0; p < n; ++p) {
    particle_[static_cast<std::size_t>(space.node[p])] = static_cast<std::int32_t>(p);
  }
  resize_with_capacity(expected_, nodes);
  resize_with_capacity(velocity_, nodes);
  resize_with_capacity(spring_, nodes);
  resize_with_capacity(stiffness_, nodes);
  const std::size_t components = affine.size() / n;
  const double decay = std::exp(-how.duration);
  rounding_ = 0;
  for (std::size_t q = 0; q < nodes; ++q) {
    const auto p = static_cast<std::size_t>(particle_[q]);
    stiffness_[q] = has_inertia()
                        ? stiffness_of(mass[q], how.stiffness, rotating)
                        : stiffness_of(least[q], decay * how.stiffness / least[q].x, rotating);
    expected_[q] = velocity_[q] = spring_[q] = {};
    ForceRecord<D> force = first_[q];
    for (std::size_t k = 0; k < D; ++k) {
      component(force, k) = 0;
      for (std::size_t l = 0; l < D; ++l) {
        component(force, k) += stretch[D * k + l] * component(first_[q], l);
      }
    }
    const double radius = 1 / least[q].inverse_radius;
    for (std::size_t k = 0; k < components; ++k) {
      const double length = k < D ? 1 : radius;
      const double stiffness = spring_stiffness(q, k);
      if (stiffness > 0) component(spring_[q], k) = component(force, k) / stiffness;
      if (!velocity.empty()) component(velocity_[q], k) = length * velocity[k * n + p];
      component(expected_[q], k) = length * affine[k * n + p] +
                                   how.follow * component(velocity_[q], k) -
                                   how.spring_share * component(spring_[q], k);
      if (!has_inertia()) continue;
      const double ulp =
          std::numeric_limits<double>::epsilon() * std::abs(component(expected_[q], k));
      rounding_ = std::max(rounding_, 2 * ulp * component(stiffness_[q], k));
    }
  }
}

template <int D>
void Drag<D>::follow_deformation(const BoundarySpace<D>& space, const Tensor<D>& change) {
  const std::size_t n = space.node.size();
  for (std::size_t q = 0; q < expected_.size(); ++q) {
    const double* x = space.reference.data() + particle_[q];
    for (std::size_t k = 0; k < D; ++k) {
      component(expected_[q], k) += dot<D>(change.data() + D * k, x, n);
    }
  }
}

template <int D>
void Drag<D>::restart_rotations(std::span<const Place> particles) {
  if constexpr (D == 3) {
    const std::size_t n = particles.size();
    for (std::size_t q = 0; q < expected_.size(); ++q) {
      const auto p = static_cast<std::size_t>(particle_[q]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double turned = component(particles[p], 3 + k);
        component(expected_[q], 3 + k) -= turned;
        part_start_[(3 + k) * n + p] -= turned / particles[p].radius;
      }
    }
  }
}

template <int D>
auto Drag<D>::excess(std::size_t q, std::span<const Place> particles) const -> Place {
  Place result;
  simd::store(&result.x,
              load<D>(particles[static_cast<std::size_t>(particle_[q])]) - load<D>(expected_[q]));
  return result;
}

template <int D>
auto Drag<D>::carried_excess(std::size_t q, std::span<const Place> particles) const -> Place {
  Place result = excess(q, particles);
  if (!has_inertia()) return result;
  for (std::size_t k = 0; k < D; ++k) {
    component(result, k) +=
        how_.follow * component(velocity_[q], k) - how_.spring_share * component(spring_[q], k);
  }
  return result;
}

template <int D>
auto Drag<D>::free_velocity(std::size_t q, std::span<const Place> particles) const -> Place {
  const Place distance = excess(q, particles);
  Place result = velocity_[q];
  for (std::size_t k = 0; k < Dimension<D>::unknowns; ++k) {
    component(result, k) +=
        velocity_by_excess() *
        ((1 / how_.theta - 1) * component(spring_[q], k) + component(distance, k));
  }
  return result;
}

template <int D>
void Drag<D>::subtract_from(std::span<ForceRecord<D>> forces,
                            std::span<const Place> particles) const {
  for (std::size_t q = 0; q < expected_.size(); ++q) {
    const auto distance =
        load<D>(particles[static_cast<std::size_t>(particle_[q])]) - load<D>(expected_[q]);
    simd::store(&forces[q].x, load<D>(forces[q]) - load<D>(stiffness_[q]) * distance);
  }
}

template <int D>
void Drag<D>::add_to(std::span<MassRecord<D>> masses, double factor) const {
  for (std::size_t q = 0; q < expected_.size(); ++q) {
    simd::store(&masses[q].x, load<D>(masses[q]) + factor * load<D>(stiffness_[q]));
  }
}

template <int D>
double Drag<D>::largest(std::span<const Place> particles) const {
  Record<D> most{};
  for (std::size_t q = 0; q < expected_.size(); ++q) {
    const auto distance =
        load<D>(particles[static_cast<std::size_t>(particle_[q])]) - load<D>(expected_[q]);
    most = simd::largest(most, simd::magnitude(load<D>(stiffness_[q]) * distance));
  }
  return simd::most(most);
}

template <int D>
void Drag<D>::set_first_force(std::span<const ForceRecord<D>> forces) {
  resize_with_capacity(first_, forces.size());
  std::copy(forces.begin(), forces.end(), first_.begin());
}

template <int D>
void Drag<D>::set_first_force(std::span<const Place> particles) {
  in_part_ = false;
  for (std::size_t q = 0; q < expected_.size(); ++q) {
    const auto distance =
        load<D>(particles[static_cast<std::size_t>(particle_[q])]) - load<D>(expected_[q]);
    simd::store(&first_[q].x, load<D>(stiffness_[q]) * distance);
  }
}

// Series of (1 - (1 + h) exp(-h)) / h and its derivative, which cancel for short parts.
MeanPull mean_pull(double h) {
  MeanPull result;
  if (h > 0.1) {
    const double decay = std::exp(-h);
    result.value = (1 - (1 + h) * decay) / h;
    result.slope = decay - result.value / h;
    return result;
  }
  double power = 1;  // (-h)^(k - 2) / k!
  for (int k = 2; k < 14; ++k) {
    power /= k;
    result.value += (k - 1) * power * h;
    result.slope += (k - 1) * (k - 1) * power;
    power *= -h;
  }
  return result;
}

template <int D>
void Drag<D>::find_velocity(const BoundarySpace<D>& space, std::span<const Place> particles,
                            std::span<const double> affine, const Tensor<D>& stretch,
                            std::span<double> velocity) {
  const std::size_t n = particles.size(), nodes = expected_.size();
  const std::size_t components = affine.size() / n;
  resize_with_capacity(node_velocity_, components * nodes);
  has_inertia() ? find_particle_velocity(space, particles, stretch)
                : find_mass_velocity(particles, affine);
  if constexpr (D == 2) AverageMasses::project_out_velocity(space, nodes, node_velocity_);
  for (std::size_t k = 0; k < components; ++k) {
    for (std::size_t p = 0; p < n; ++p) {
      velocity[k * n + p] = node_velocity_[k * nodes + static_cast<std::size_t>(space.node[p])];
    }
  }
}

// u = exp(-h) ((1 + h) u_0 + h f_0 / k) + mean_pull(h) (displacement beyond affine motion)
template <int D>
void Drag<D>::find_mass_velocity(std::span<const Place> particles, std::span<const double> affine) {
  const std::size_t n = particles.size();
  const std::size_t nodes = expected_.size();
  const std::size_t components = affine.size() / n;
  const double h = how_.duration;
  const double decay = std::exp(-h);
  const double pull = mean_pull(h).value;
  for (std::size_t q = 0; q < nodes; ++q) {
    const auto p = static_cast<std::size_t>(particle_[q]);
    for (std::size_t k = 0; k < components; ++k) {
      const double length = k < D ? 1 : particles[p].radius;
      const double moved = component(particles[p], k) - length * affine[k * n + p];
      const double start = (1 + h) * component(velocity_[q], k) + h * component(spring_[q], k);
      node_velocity_[k * nodes + q] = (decay * start + pull * moved) / length;
    }
  }
}

// v = w - (1 - G^-T) (v_0 + w) / 2 with the free velocity w; rotations w. @formula inertia-velocity
template <int D>
void Drag<D>::find_particle_velocity(const BoundarySpace<D>& space,
                                     std::span<const Place> particles, const Tensor<D>& stretch) {
  const std::size_t nodes = expected_.size();
  const Tensor<D> carry = transpose<D>(inverse<D>(stretch));
  for (std::size_t q = 0; q < nodes; ++q) {
    const unsigned char fixed = space.fixed.empty() ? 0 : space.fixed[q];
    const Place free = free_velocity(q, particles);
    Vec<D> both{};
    for (std::size_t k = 0; k < D; ++k) both[k] = component(velocity_[q], k) + component(free, k);
    const Vec<D> carried = product<D>(carry, both);
    const double radius = particles[static_cast<std::size_t>(particle_[q])].radius;
    for (std::size_t k = 0; k * nodes < node_velocity_.size(); ++k) {
      double velocity = component(free, k) / (k < D ? 1 : radius);
      if (k < D) velocity += 0.5 * (carried[k] - both[k]);
      node_velocity_[k * nodes + q] = (fixed & fixed_bit(k)) != 0 ? 0 : velocity;
    }
  }
}

template <int D>
double Drag<D>::work(std::span<const Place> particles, std::span<const double> affine) const {
  const std::size_t n = particles.size();
  const std::size_t components = affine.size() / n;
  double sum = 0;
  for (std::size_t q = 0; q < expected_.size(); ++q) {
    const auto p = static_cast<std::size_t>(particle_[q]);
    const Place distance = excess(q, particles);
    for (std::size_t k = 0; k < components; ++k) {
      const double length = k < D ? 1 : particles[p].radius;
      double moved = component(particles[p], k) - length * affine[k * n + p];
      if (k >= D) moved += length * how_.turn[k - D];
      const double drag = component(stiffness_[q], k) * component(distance, k);
      sum += 0.5 * (component(first_[q], k) + drag) * moved;
    }
  }
  return sum;
}

template class Drag<2>;
template class Drag<3>;

}  // namespace grainlaw::core
