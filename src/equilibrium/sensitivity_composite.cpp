// Sensitivities of Hertz-Mindlin contacts, whose springs follow the overlap, and of moments.
#include "equilibrium/sensitivity.hpp"

#include "room.hpp"

#include <array>
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

// Per touching contact under a change of F (row-major, a lane per change) and of the history, with
// `motion` of the nodes beside, or none.
void Sensitivity::find_moment_changes(const Increment& increment,
                                      const std::array<Quad, 4>& deformation,
                                      const Stiffness& stiffness, std::span<const Quad> motion) {
  const auto touching = stiffness.touching();
  const auto moments = stiffness.moments();
  const auto& f = increment.deformation;
  const double det = f[0] * f[3] - f[1] * f[2];
  resize_with_room(moment_changes_, touching.size());
  for (std::size_t m = 0; m < touching.size(); ++m) {
    const auto& contact = touching[m];
    const auto& point = contact.point;
    const double rx = (f[3] * point.branch_x - f[1] * point.branch_y) / det;
    const double ry = (-f[2] * point.branch_x + f[0] * point.branch_y) / det;
    for (std::size_t k = 0; k < width; ++k) {
      double normal = point.normal_x * (deformation[0].lane[k] * rx + deformation[1].lane[k] * ry) +
                      point.normal_y * (deformation[2].lane[k] * rx + deformation[3].lane[k] * ry);
      double spin = 0;
      if (!motion.empty()) {
        const Quad* zi = &motion[3 * contact.node_i];
        const Quad* zj = &motion[3 * contact.node_j];
        normal += point.normal_x * (zj[0].lane[k] - zi[0].lane[k]) +
                  point.normal_y * (zj[1].lane[k] - zi[1].lane[k]);
        spin = zj[2].lane[k] - zi[2].lane[k];
      }
      double change = moments[m].by_normal * normal + moments[m].by_spin * spin;
      if (carried_ && !moments[m].capped) {
        change += start_moment_[contact.index].lane[k] +
                  increment.contacts.bending_stiffness[contact.index] *
                      start_spin_[contact.index].lane[k];
      }
      moment_changes_[m].lane[k] = change;
    }
  }
}

void Sensitivity::add_moments(const Stiffness& stiffness) {
  const auto touching = stiffness.touching();
  for (std::size_t m = 0; m < touching.size(); ++m) {
    for (std::size_t k = 0; k < width; ++k) {
      right_[3 * touching[m].node_i + 2].lane[k] -= moment_changes_[m].lane[k];
      right_[3 * touching[m].node_j + 2].lane[k] += moment_changes_[m].lane[k];
    }
  }
}

}  // namespace grainlaw
