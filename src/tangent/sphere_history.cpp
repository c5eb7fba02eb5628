// Derivatives of the contact history of spheres.
#include "tangent/sphere_history.hpp"

#include "base/capacity.hpp"
#include "contact/contact_point.hpp"
#include "increment/contact_state.hpp"
#include "packing/geometry.hpp"

#include <cmath>

namespace grainlaw::core {

void HistoryDerivatives<3>::carry(const Increment<3>& increment,
                                  std::span<const ContactChange<3>> changes,
                                  std::span<const ByDeformation<3>> moment_changes,
                                  std::span<const std::int32_t> index) {
  const auto& list = increment.contacts();
  const bool moments = increment.problem().law->moments();
  carried_force_.clear();
  carried_moment_.clear();
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (!bears_load(increment, c)) continue;
    const auto k = static_cast<std::size_t>(index[c]);
    const auto keep = [&](const TripleByDeformation& change, std::vector<TripleByDeformation>& to) {
      to.push_back(change);
      for (auto& component : to.back()) {
        for (double& value : component.lane) value /= list.weight_of(c);
      }
    };
    keep(changes[k].tangential_force, carried_force_);
    if (!moments) continue;
    keep({moment_changes[3 * k], moment_changes[3 * k + 1], moment_changes[3 * k + 2]},
         carried_moment_);
  }
  keep_capacity(carried_force_);
  keep_capacity(carried_moment_);
}

void HistoryDerivatives<3>::start(const Increment<3>& increment,
                                  std::span<const ByDeformation<3>> motion,
                                  const DeformationChange<3>& change) {
  constexpr std::size_t width = Dimension<3>::lanes;
  const auto& list = increment.contacts();
  const auto& law = *increment.problem().law;
  const auto& history = increment.history().contacts();
  const std::size_t b = Dimension<3>::unknowns;
  const Tensor<3> cell = tensor_of<3>(increment.problem().packing->cell);
  const Tensor<3> pull_back = inverse<3>(increment.motion().start_deformation());
  motion_ = motion;
  resize_with_capacity(normal_, list.size());
  resize_with_capacity(force_, list.size());
  if (law.moments()) resize_with_capacity(moment_, list.size());
  std::size_t h = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto i = static_cast<std::size_t>(list.i[c]);
    const auto j = static_cast<std::size_t>(list.j[c]);
    const Vec<3> shift =
        product<3>(cell, Vec<3>{list.shift[0][c], list.shift[1][c], list.shift[2][c]});
    const Vec<3> l = branch<3>(increment.motion().start().data(), increment.problem().particles(),
                               i, j, increment.motion().start_deformation(), shift);
    const Vec<3> reference = product<3>(pull_back, l);
    const double d = std::sqrt(square<3>(l));
    const auto key = key_of(increment.pairs()[c]);
    while (h < history.size() && key_of(history[h]) < key) ++h;
    const bool known = h < history.size() && key_of(history[h]) == key;
    const double overlap = list.reach[c] - d;
    // The list starts Hertz-Mindlin contacts from force / overlap^(1/4).
    const double scale = law.hertzian() ? (overlap > 0 ? 1 / start_scale(overlap, law) : 0) : 1;
    for (std::size_t lane = 0; lane < width; ++lane) {
      Vec<3> dl{};
      for (std::size_t k = 0; k < 3; ++k) {
        dl[k] = motion[j * b + k].lane[lane] - motion[i * b + k].lane[lane];
        for (std::size_t m = 0; m < 3; ++m) dl[k] += change[3 * k + m].lane[lane] * reference[m];
      }
      const double along = dot(l, dl) / (d * d);
      for (std::size_t k = 0; k < 3; ++k) {
        normal_[c][k].lane[lane] = (dl[k] - along * l[k]) / d;
        const auto start_of = [&](const auto& carried, const auto& start) {
          double change = known ? scale * list.weight_of(c) * carried[h][k].lane[lane] : 0;
          if (law.hertzian() && overlap > 0) change += 0.25 * start[k][c] * along * d / overlap;
          return change;
        };
        force_[c][k].lane[lane] = start_of(carried_force_, list.start_force);
        if (law.moments()) {
          moment_[c][k].lane[lane] = start_of(carried_moment_, list.start_moment);
        }
      }
    }
  }
}

}  // namespace grainlaw::core
