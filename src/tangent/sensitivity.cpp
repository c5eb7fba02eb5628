#include "tangent/sensitivity.hpp"

#include "base/capacity.hpp"
#include "increment/contact_state.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

// Change of F at a share of the increment, with the found components of `found`.
template <int D>
DeformationChange<D> change_at(double share, const Increment<D>& increment,
                               const DeformationChange<D>& found) {
  const auto& space = *increment.problem().space;
  DeformationChange<D> change = directions<D>(increment.motion().committed_deformation());
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) {
      change[k] = found[k];
    } else {
      for (double& value : change[k].lane) value *= share;
    }
  }
  return change;
}

// Applies F F0^-1 to the translations in `motion`, `b` components per node.
template <int D>
void push_forward(const Tensor<D>& f, const Tensor<D>& f0, std::size_t b,
                  std::span<ByDeformation<D>> motion) {
  constexpr std::size_t width = Dimension<D>::lanes;
  const Tensor<D> g = product<D>(f, inverse<D>(f0));
  for (std::size_t q = 0; q < motion.size(); q += b) {
    std::array<simd::Lanes<width>, static_cast<std::size_t>(D)> x;
    for (std::size_t k = 0; k < D; ++k) x[k] = simd::load<width>(motion[q + k].lane);
    for (std::size_t k = 0; k < D; ++k) {
      auto sum = g[D * k] * x[0];
      for (std::size_t l = 1; l < D; ++l) sum += g[D * k + l] * x[l];
      simd::store(motion[q + k].lane, sum);
    }
  }
}

}  // namespace

template <int D>
bool Sensitivity<D>::solve(Increment<D>& increment, double share, double start_share,
                           Stiffness<D>& stiffness) {
  const auto& space = *increment.problem().space;
  const auto& law = *increment.problem().law;
  HistoryChange<D> history;
  if (carried_) {
    history_.start(increment, carried_motion_,
                   change_at<D>(start_share, increment, carried_change_));
    history = history_.of_list(law.moments());
  }
  increment.find_two_contact_spheres();
  if constexpr (D == 3) arbitrary_ = arbitrary_ || increment.two_contact_spheres().arbitrary();
  stiffness.assemble(increment, 0);
  const auto touching = stiffness.touching();
  change_ = change_at<D>(share, increment, {});

  const auto b = static_cast<std::size_t>(increment.problem().components());
  resize_with_capacity(motion_, increment.problem().node_unknowns());
  right_.assign(increment.problem().node_unknowns(), ByDeformation<D>{});
  add_residual_changes<D>(increment, stiffness, change_, history, right_);
  if (increment.motion().drag().acts()) drag_.add_to(increment, change_, right_);
  if (!space.identity) {
    for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
      for (std::size_t k = 0; k < b; ++k) {
        if ((space.fixed[q] & fixed_bit(k)) != 0) right_[q * b + k] = {};
      }
    }
  }
  if (!stiffness.solve_together(increment, right_, motion_)) return false;

  resize_with_capacity(changes_, touching.size());
  if constexpr (D == 2) {
    if (BorderedSystem::needed(space) && !complete(increment, history, stiffness)) return false;
  }
  find_contact_changes<D>(increment, touching, change_, history, motion_, changes_);
  if (law.moments()) {
    resize_with_capacity(moment_changes_, Dimension<D>::spins * touching.size());
    find_moment_changes<D>(increment, stiffness, change_, history, motion_, moment_changes_);
  }
  resize_with_capacity(index_, increment.contacts().size());
  std::fill(index_.begin(), index_.end(), -1);
  for (std::size_t k = 0; k < touching.size(); ++k) {
    index_[touching[k].index] = static_cast<std::int32_t>(k);
  }
  return true;
}

// Completes the motions by the bordered system.
template <>
bool Sensitivity<2>::complete(Increment<2>& increment, const HistoryChange<2>& history,
                              Stiffness<2>& stiffness) {
  const auto touching = stiffness.touching();
  if (increment.problem().space->finds_deformation) {
    find_contact_changes<2>(increment, touching, change_, history, motion_, changes_);
  }
  return border_.prepare(increment, stiffness) &&
         border_.complete(increment, touching, changes_, motion_, change_);
}

template <int D>
void Sensitivity<D>::carry(const Increment<D>& increment) {
  history_.carry(increment, changes_, moment_changes_, index_);
  carry_motion(increment);
  carried_change_ = change_;
  carried_ = true;
}

template <int D>
void Sensitivity<D>::carry_free(const Increment<D>& increment, double share) {
  change_ = change_at<D>(share, increment, {});
  motion_.assign(increment.problem().node_unknowns(), ByDeformation<D>{});
  carry(increment);
}

// Carries the motion like Motion::start_here: unsupported nodes go on from their last start, with
// the mean of the supported ones.
template <int D>
void Sensitivity<D>::carry_motion(const Increment<D>& increment) {
  constexpr std::size_t width = Dimension<D>::lanes;
  using simd::load;
  const auto& node = increment.problem().space->node;
  const auto b = static_cast<std::size_t>(increment.problem().components());
  if (!carried_) carried_motion_.assign(increment.problem().node_unknowns(), ByDeformation<D>{});
  if (!increment.problem().space->bound_to_axes()) {
    push_forward<D>(increment.motion().deformation(), increment.motion().start_deformation(), b,
                    carried_motion_);
  }
  find_supported(increment, supported_);
  for (std::size_t k = 0; k < D; ++k) {
    simd::Lanes<width> sum{};
    double count = 0;
    for (const int q : node) {
      if ((supported_[static_cast<std::size_t>(q)] & fixed_bit(k)) == 0) continue;
      const std::size_t at = static_cast<std::size_t>(q) * b + k;
      sum += load<width>(motion_[at].lane) - load<width>(carried_motion_[at].lane);
      ++count;
    }
    const simd::Lanes<width> mean = count > 0 ? sum / count : sum;
    for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
      const std::size_t at = q * b + k;
      if ((supported_[q] & fixed_bit(k)) != 0) {
        carried_motion_[at] = motion_[at];
      } else {
        simd::store(carried_motion_[at].lane, load<width>(carried_motion_[at].lane) + mean);
      }
    }
  }
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    for (std::size_t k = D; k < b; ++k) carried_motion_[q * b + k] = motion_[q * b + k];
  }
}

template class Sensitivity<2>;
template class Sensitivity<3>;

}  // namespace grainlaw::core
