#include "tangent/drag_change.hpp"

#include "base/capacity.hpp"

#include <cmath>

namespace grainlaw::core {

namespace {

template <int D>
using Lanes = simd::Lanes<Dimension<D>::lanes>;

template <int D>
Lanes<D> load(const ByDeformation<D>& value) {
  return simd::load<Dimension<D>::lanes>(value.lane);
}

// Change of a number whose derivative by F at the end of the increment is `by`.
template <int D>
Lanes<D> change_of(const Tensor<D>& by, const Increment<D>& increment) {
  const auto change = directions<D>(increment.motion().committed_deformation());
  Lanes<D> result{};
  for (std::size_t k = 0; k < squared<D>; ++k) result += by[k] * load<D>(change[k]);
  return result;
}

}  // namespace

template <>
std::array<double, 1> rotation_by_spin<2>(const Increment<2>& /*increment*/, std::size_t /*q*/) {
  return {1};
}

// Derivative of a Gibbs vector by a spin that is added to it.
template <>
std::array<double, 9> rotation_by_spin<3>(const Increment<3>& increment, std::size_t q) {
  const std::size_t n = increment.problem().particles();
  const double* rotation = increment.motion().coordinates().data() + 3 * n + q;
  const Vec<3> t{rotation[0], rotation[n], rotation[2 * n]};
  std::array<double, 9> result{
      1, 0.5 * t[2], -0.5 * t[1], -0.5 * t[2], 1, 0.5 * t[0], 0.5 * t[1], -0.5 * t[0], 1};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 3; ++l) result[3 * k + l] += 0.25 * t[k] * t[l];
  }
  return result;
}

// Changes at node q relative to affine motion.
template <int D>
void DragDerivatives<D>::find_changes(const Increment<D>& increment, std::size_t q,
                                      Changes& changes) const {
  const auto& drag = increment.motion().drag();
  const auto b = static_cast<std::size_t>(increment.problem().components());
  const auto& how = drag.how();
  const double radius = increment.motion().node_radius()[q];
  changes.duration = change_of<D>(how.duration_by_F, increment);
  const Lanes<D> log_spring = change_of<D>(how.log_stiffness_by_F, increment);
  changes.log_stiffness = log_spring - changes.duration;
  changes.start = changes.velocity = changes.spring = {};
  if (carried_) {
    const Tensor<D> g = increment.motion().part_deformation();
    const auto push = [&](std::span<const ByDeformation<D>> from, auto& to) {
      for (std::size_t k = 0; k < D; ++k) {
        for (std::size_t l = 0; l < D; ++l) to[k] += g[D * k + l] * load<D>(from[l]);
      }
      for (std::size_t k = D; k < b; ++k) to[k] = load<D>(from[k]);
    };
    push(std::span(start_).subspan(q * b, b), changes.start);
    push(std::span(velocity_).subspan(q * b, b), changes.velocity);
    push(std::span(force_).subspan(q * b, b), changes.spring);
  }
  for (std::size_t k = 0; k < b; ++k) {
    const double length = k < D ? 1 : radius;
    const double stiffness = drag.spring_stiffness(q, k) * length * length;
    const double velocity = component(drag.velocity(q), k) / length;
    const double spring = component(drag.spring(q), k) / length;
    if (stiffness > 0) changes.spring[k] *= 1 / stiffness;
    changes.spring[k] -= spring * log_spring;
    changes.expected[k] = changes.start[k] + how.follow * changes.velocity[k] -
                          how.spring_share * changes.spring[k] +
                          (how.follow_by_duration * velocity + spring) * changes.duration;
  }
}

template <int D>
void DragDerivatives<D>::add_to(const Increment<D>& increment, const DeformationChange<D>& change,
                                std::span<ByDeformation<D>> residual) {
  const auto& drag = increment.motion().drag();
  const auto b = static_cast<std::size_t>(increment.problem().components());
  const bool affine = !increment.problem().space->bound_to_axes();
  const Tensor<D> back = inverse<D>(increment.motion().deformation());
  Changes changes;
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    find_changes(increment, q, changes);
    const auto distance = drag.excess(q, increment.motion().records());
    if (affine) {
      Vec<D> reference{};
      const auto carried = drag.carried_excess(q, increment.motion().records());
      for (std::size_t k = 0; k < D; ++k) reference[k] = component(carried, k);
      reference = product<D>(back, reference);
      for (std::size_t k = 0; k < D; ++k) {
        for (std::size_t l = 0; l < D; ++l) {
          changes.expected[k] -= load<D>(change[D * k + l]) * reference[l];
        }
      }
    }
    const double radius = increment.motion().node_radius()[q];
    for (std::size_t k = 0; k < b; ++k) {
      const double length = k < D ? 1 : radius;
      const double stiffness = component(drag.stiffness(q), k) * length;
      double* const at = residual[q * b + k].lane;
      simd::store(at, simd::load<Dimension<D>::lanes>(at) +
                          stiffness * (length * changes.expected[k] -
                                       component(distance, k) * changes.log_stiffness));
    }
  }
}

template <int D>
void DragDerivatives<D>::carry(const Increment<D>& increment,
                               std::span<const ByDeformation<D>> motion) {
  const auto& drag = increment.motion().drag();
  const auto b = static_cast<std::size_t>(increment.problem().components());
  for (auto* column : {&start_, &velocity_, &force_}) resize_with_capacity(*column, motion.size());
  const double h = drag.how().duration;
  const double decay = std::exp(-h);
  const MeanPull pull = mean_pull(h);
  Changes changes;
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    const std::size_t at = q * b;
    find_changes(increment, q, changes);
    const auto distance = drag.excess(q, increment.motion().records());
    const double radius = increment.motion().node_radius()[q];
    const auto turn = rotation_by_spin<D>(increment, q);
    for (std::size_t k = 0; k < b; ++k) {
      Lanes<D> place{};
      if (k < D) place = load<D>(motion[at + k]);
      for (std::size_t l = 0; k >= D && l + D < b; ++l) {
        place += turn[(k - D) * Dimension<D>::spins + l] * load<D>(motion[at + D + l]);
      }
      const double length = k < D ? 1 : radius;
      const double stiffness = component(drag.stiffness(q), k) * length;
      simd::store(force_[at + k].lane,
                  stiffness * (length * (place - changes.expected[k]) +
                               component(distance, k) * changes.log_stiffness));
      const double velocity = component(drag.velocity(q), k) / length;
      const double spring = component(drag.spring(q), k) / length;
      const double moved =
          component(distance, k) / length + drag.how().follow * velocity - (1 - h) * spring;
      simd::store(
          velocity_[at + k].lane,
          decay * ((1 + h) * changes.velocity[k] + h * changes.spring[k]) +
              pull.value * (place - changes.start[k]) +
              (decay * ((1 - h) * spring - h * velocity) + pull.slope * moved) * changes.duration);
      // Rotations of spheres count from the start of the part.
      start_[at + k] = D == 3 && k >= D ? ByDeformation<D>{} : motion[at + k];
    }
  }
  carried_ = true;
}

template class DragDerivatives<2>;
template class DragDerivatives<3>;

}  // namespace grainlaw::core
