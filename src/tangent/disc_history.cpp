// Derivatives of the contact history of discs.
#include "tangent/disc_history.hpp"
#include "base/capacity.hpp"
#include "contact/contact_point.hpp"
#include "increment/contact_state.hpp"
#include "packing/geometry.hpp"

#include <cmath>

namespace grainlaw::core {

namespace {

constexpr std::size_t width = 4;

// Branches at the start of the history, and in the reference that F deforms.
struct StartBranches {
  static Tensor<2> cell_of(const Packing& packing) {
    return packing.frame ? Tensor<2>{} : tensor_of<2>(packing.cell);
  }
  explicit StartBranches(const Increment<2>& of)
      : increment(of),
        f(of.motion().start_deformation()),
        inverse(grainlaw::core::inverse<2>(f)),
        cell(cell_of(*of.problem().packing)) {}

  [[nodiscard]] Vec<2> of(std::size_t c) const {
    const auto& list = increment.contacts();
    const Vec<2> shift = product<2>(cell, Vec<2>{list.shift[0][c], list.shift[1][c]});
    return branch<2>(increment.motion().start().data(), increment.problem().particles(),
                     static_cast<std::size_t>(list.i[c]), static_cast<std::size_t>(list.j[c]), f,
                     shift);
  }

  const Increment<2>& increment;
  const Tensor<2>& f;
  const Tensor<2> inverse;
  const Tensor<2> cell;
};

}  // namespace

void HistoryDerivatives<2>::carry(const Increment<2>& increment,
                                  std::span<const ContactChange<2>> changes,
                                  std::span<const ByDeformation<2>> moment_changes,
                                  std::span<const std::int32_t> index) {
  const auto& list = increment.contacts();
  const bool moments = increment.problem().law->moments();
  carried_force_.clear();
  carried_moment_.clear();
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (!bears_load(increment, c)) continue;
    const auto k = static_cast<std::size_t>(index[c]);
    ByDeformation<2> force = changes[k].tangential_force[0];
    for (double& value : force.lane) value /= list.weight_of(c);
    carried_force_.push_back(force);
    if (!moments) continue;
    ByDeformation<2> moment = moment_changes[k];
    for (double& value : moment.lane) value /= list.weight_of(c);
    carried_moment_.push_back(moment);
  }
  keep_capacity(carried_force_);
  keep_capacity(carried_moment_);
}

void HistoryDerivatives<2>::start(const Increment<2>& increment,
                                  std::span<const ByDeformation<2>> motion,
                                  const DeformationChange<2>& change) {
  const auto& list = increment.contacts();
  const auto& node = increment.problem().space->node;
  const auto& law = *increment.problem().law;
  const bool rotating = law.rotating();
  const bool moments = law.moments();
  const bool hertzian = law.hertzian();
  const std::size_t b = rotating ? 3 : 2;
  const StartBranches branches(increment);
  const bool bound_to_axes = increment.problem().space->bound_to_axes();
  resize_with_capacity(rotation_, list.size());
  resize_with_capacity(force_, list.size());
  if (hertzian) resize_with_capacity(overlap_, list.size());
  if (moments) {
    resize_with_capacity(moment_, list.size());
    resize_with_capacity(spin_, list.size());
  }
  std::size_t h = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto i = static_cast<std::size_t>(list.i[c]);
    const auto j = static_cast<std::size_t>(list.j[c]);
    const auto [lx, ly] = branches.of(c);
    const double d2 = lx * lx + ly * ly;
    const Vec<2> reference = bound_to_axes ? fixed_branch_of(increment, c)
                                           : product<2>(branches.inverse, Vec<2>{lx, ly});
    const auto* zi = &motion[static_cast<std::size_t>(node[i]) * b];
    const auto* zj = &motion[static_cast<std::size_t>(node[j]) * b];
    for (std::size_t k = 0; k < width; ++k) {
      const double dx = zj[0].lane[k] - zi[0].lane[k] + change[0].lane[k] * reference[0] +
                        change[1].lane[k] * reference[1];
      const double dy = zj[1].lane[k] - zi[1].lane[k] + change[2].lane[k] * reference[0] +
                        change[3].lane[k] * reference[1];
      rotation_[c].lane[k] = -(lx * dy - ly * dx) / d2;
      if (hertzian) overlap_[c].lane[k] = -(lx * dx + ly * dy) / std::sqrt(d2);
      if (moments) spin_[c].lane[k] = zj[2].lane[k] - zi[2].lane[k];
      if (rotating) {
        rotation_[c].lane[k] +=
            list.lever_i[c] * zi[2].lane[k] + (1 - list.lever_i[c]) * zj[2].lane[k];
      }
    }
    force_[c] = {};
    if (moments) moment_[c] = {};
    const auto key = key_of(increment.pairs()[c]);
    const auto& history = increment.history().contacts();
    while (h < history.size() && key_of(history[h]) < key) ++h;
    if (h == history.size() || key_of(history[h]) != key) continue;
    for (std::size_t k = 0; k < width; ++k) {
      force_[c].lane[k] = list.weight_of(c) * carried_force_[h].lane[k];
      if (moments) moment_[c].lane[k] = list.weight_of(c) * carried_moment_[h].lane[k];
    }
  }
  if (hertzian) rescale(increment);
}

// Converts the changes of force / overlap^(1/4) and of rotation to those of a linear spring with
// the list's stiffness.
void HistoryDerivatives<2>::rescale(const Increment<2>& increment) {
  const auto& list = increment.contacts();
  const auto& law = *increment.problem().law;
  const bool moments = law.moments();
  const StartBranches branches(increment);
  for (std::size_t c = 0; c < list.size(); ++c) {
    const double overlap = list.reach[c] - length<2>(branches.of(c));
    const double scale = start_scale(overlap_of(increment, c), law);
    for (std::size_t k = 0; k < width; ++k) {
      // A contact that was open has no spring.
      const double shift = overlap > 0 ? 0.25 * overlap_[c].lane[k] / overlap : 0;
      const double fade = overlap > 0 ? scale / start_scale(overlap, law) : 0;
      force_[c].lane[k] = fade * force_[c].lane[k] - scale * shift * list.start_force[0][c];
      rotation_[c].lane[k] *= scale * scale;
      if (!moments) continue;
      moment_[c].lane[k] = fade * moment_[c].lane[k] - scale * shift * list.start_moment[0][c];
      spin_[c].lane[k] *= scale * scale;
    }
  }
}

}  // namespace grainlaw::core
