// Sensitivities of Hertz-Mindlin contacts, whose springs follow the overlap.
#include "tangent/sensitivity.hpp"

#include "base/room.hpp"

#include <cmath>

namespace grainlaw {

namespace {

constexpr std::size_t width = 4;

}  // namespace

// The list starts from force / overlap^(1/4); here that change, and the one of the turn, become those
// of a linear spring with the stiffness that the list names.
void Sensitivity::rescale_start(const Increment& increment) {
  const auto& list = increment.contacts;
  const auto& law = *increment.problem->law;
  const bool moments = law.moments();
  const auto n = increment.particles();
  const auto& start = increment.start;
  const auto& f = increment.start_deformation;
  const double* h0 = increment.problem->packing->cell.data();
  const bool frame = increment.problem->packing->frame.has_value();
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto i = static_cast<std::size_t>(list.i[c]);
    const auto j = static_cast<std::size_t>(list.j[c]);
    const double ax = frame ? 0 : h0[0] * list.shift_x[c] + h0[1] * list.shift_y[c];
    const double ay = frame ? 0 : h0[2] * list.shift_x[c] + h0[3] * list.shift_y[c];
    const double overlap =
        list.reach[c] - std::hypot(start[j] - start[i] + f[0] * ax + f[1] * ay,
                                   start[n + j] - start[n + i] + f[2] * ax + f[3] * ay);
    const double scale = start_scale(increment.overlap(c), law);
    for (std::size_t k = 0; k < width; ++k) {
      // A contact that was open has no spring.
      const double shift = overlap > 0 ? 0.25 * start_overlap_[c].lane[k] / overlap : 0;
      const double fade = overlap > 0 ? scale / start_scale(overlap, law) : 0;
      start_force_[c].lane[k] =
          fade * start_force_[c].lane[k] - scale * shift * list.start_force[c];
      start_turn_[c].lane[k] *= scale * scale;
      if (!moments) continue;
      start_moment_[c].lane[k] =
          fade * start_moment_[c].lane[k] - scale * shift * list.start_moment[c];
      start_spin_[c].lane[k] *= scale * scale;
    }
  }
}

}  // namespace grainlaw
