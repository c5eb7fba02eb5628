#include "tangent/drag_change.hpp"

#include "base/capacity.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

template <int D>
using Lanes = simd::Lanes<Dimension<D>::lanes>;

template <int D>
Lanes<D> load(const ByDeformation<D>& value) {
  return simd::load<Dimension<D>::lanes>(value.lane);
}

// Change of rho with the change of F. @formula inertia
template <int D>
Lanes<D> follow_change(const Drag<D>& drag, const DeformationChange<D>& change) {
  const Tensor<D> back = inverse<D>(drag.from());
  const Tensor<D>& by = drag.how().follow_by_stretch;
  Lanes<D> result{};
  for (std::size_t k = 0; k < D; ++k) {
    for (std::size_t m = 0; m < D; ++m) {
      double factor = 0;  // of the change of F_km
      for (std::size_t l = 0; l < D; ++l) factor += by[D * k + l] * back[D * m + l];
      result += factor * load<D>(change[D * k + m]);
    }
  }
  return result;
}

template <int D>
Tensor<D> part_deformation(const Increment<D>& increment) {
  if (increment.problem().space->bound_to_axes()) return identity<D>();
  return product<D>(increment.motion().deformation(), inverse<D>(increment.motion().drag().from()));
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

template <int D>
void DragDerivatives<D>::add_to(const Increment<D>& increment, const DeformationChange<D>& change,
                                std::span<ByDeformation<D>> residual) {
  const auto& drag = increment.motion().drag();
  const auto b = static_cast<std::size_t>(increment.problem().components());
  const bool affine = !increment.problem().space->bound_to_axes();
  const Tensor<D> back = inverse<D>(increment.motion().deformation());
  const Tensor<D> g = part_deformation(increment);
  const Lanes<D> follow = follow_change(drag, change);
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    const auto distance = drag.excess(q, increment.motion().records());
    std::array<Lanes<D>, Dimension<D>::unknowns> expected{};  // beyond affine motion
    if (carried_) {
      std::array<Lanes<D>, Dimension<D>::unknowns> start{};
      for (std::size_t k = 0; k < b; ++k) {
        start[k] = load<D>(start_[q * b + k]) + drag.how().follow * load<D>(move_[q * b + k]);
      }
      for (std::size_t k = 0; k < D; ++k) {
        for (std::size_t l = 0; l < D; ++l) expected[k] += g[D * k + l] * start[l];
      }
      for (std::size_t k = D; k < b; ++k) expected[k] = start[k];
    }
    const double radius = increment.motion().node_radius()[q];
    for (std::size_t k = 0; k < b; ++k) {
      const double length = k < D ? 1 : radius;
      expected[k] += ((&drag.move(q).x)[k] / length) * follow;
    }
    if (affine) {
      Vec<D> reference{};
      for (std::size_t k = 0; k < D; ++k) reference[k] = component(distance, k);
      reference = product<D>(back, reference);
      for (std::size_t k = 0; k < D; ++k) {
        for (std::size_t l = 0; l < D; ++l) {
          expected[k] -= load<D>(change[D * k + l]) * reference[l];
        }
      }
    }
    for (std::size_t k = 0; k < b; ++k) {
      const double length = k < D ? 1 : radius;
      const double stiffness = (&drag.stiffness(q).x)[k] * length * length;
      double* const at = residual[q * b + k].lane;
      simd::store(at, simd::load<Dimension<D>::lanes>(at) + stiffness * expected[k]);
    }
  }
}

template <int D>
void DragDerivatives<D>::carry(const Increment<D>& increment,
                               std::span<const ByDeformation<D>> motion) {
  const auto b = static_cast<std::size_t>(increment.problem().components());
  const Tensor<D> g = part_deformation(increment);
  const std::size_t size = motion.size();
  if (!carried_) {
    resize_with_capacity(start_, size);
    resize_with_capacity(move_, size);
    std::fill(start_.begin(), start_.end(), ByDeformation<D>{});
  }
  carried_ = true;
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    const std::size_t at = q * b;
    for (std::size_t k = 0; k < D; ++k) {
      Lanes<D> before{};
      for (std::size_t l = 0; l < D; ++l) before += g[D * k + l] * load<D>(start_[at + l]);
      simd::store(move_[at + k].lane, load<D>(motion[at + k]) - before);
    }
    const auto turn = rotation_by_spin<D>(increment, q);
    for (std::size_t k = 0; k + D < b; ++k) {
      Lanes<D> rotation{};
      for (std::size_t l = 0; l + D < b; ++l) {
        rotation += turn[k * Dimension<D>::spins + l] * load<D>(motion[at + D + l]);
      }
      simd::store(move_[at + D + k].lane, rotation - load<D>(start_[at + D + k]));
    }
    for (std::size_t k = 0; k < b; ++k) {
      // Rotations of spheres count from the start of the part.
      const bool anew = D == 3 && k >= D;
      start_[at + k] = anew ? ByDeformation<D>{} : motion[at + k];
    }
  }
}

template class DragDerivatives<2>;
template class DragDerivatives<3>;

}  // namespace grainlaw::core
