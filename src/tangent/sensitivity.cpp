#include "tangent/sensitivity.hpp"

#include "base/room.hpp"
#include "linear/quad.hpp"
#include "math/pull_back.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainlaw {

using namespace quad;

namespace {

// Change of F at a share of the way; found components are those of `found`.
DeformationChange change_at(double share, const BoundarySpace& space,
                            const DeformationChange& found) {
  DeformationChange change{};
  for (std::size_t k = 0; k < width; ++k) {
    if (space.found[k]) {
      change[k] = found[k];
    } else {
      change[k].lane[k] = share;
    }
  }
  return change;
}

// F F0^-1 of the translations, `b` components a node.
void push_forward(const std::array<double, 4>& f, const std::array<double, 4>& f0, std::size_t b,
                  std::span<Quad> motion) {
  const PullBack pull_back(f0);
  const auto [g11, g21] = pull_back(1, 0);
  const auto [g12, g22] = pull_back(0, 1);
  const double a = f[0] * g11 + f[1] * g21;
  const double c = f[0] * g12 + f[1] * g22;
  const double d = f[2] * g11 + f[3] * g21;
  const double e = f[2] * g12 + f[3] * g22;
  for (std::size_t q = 0; q < motion.size(); q += b) {
    const Lanes x = load(motion[q].lane);
    const Lanes y = load(motion[q + 1].lane);
    store(motion[q].lane, a * x + c * y);
    store(motion[q + 1].lane, d * x + e * y);
  }
}

}  // namespace

void Sensitivity::start_of_history(const Increment& increment, double start_share) {
  const auto& list = increment.contacts;
  const auto& node = increment.problem->space->node;
  const auto n = increment.particles();
  const auto& law = *increment.problem->law;
  const bool rotating = law.rotating();
  const bool moments = law.moments();
  const bool hertzian = law.hertzian();
  const std::size_t b = rotating ? 3 : 2;
  const bool frame = increment.problem->packing->frame.has_value();
  const double* h0 = increment.problem->packing->cell.data();
  const auto& f = increment.start_deformation;
  const PullBack pull_back(f);
  const double* x = increment.start.data();
  const auto start_change = change_at(start_share, *increment.problem->space, carried_change_);
  const bool bound_to_axes = increment.problem->space->bound_to_axes();
  resize_with_room(start_turn_, list.size());
  resize_with_room(start_force_, list.size());
  if (hertzian) resize_with_room(start_overlap_, list.size());
  if (moments) {
    resize_with_room(start_moment_, list.size());
    resize_with_room(start_spin_, list.size());
  }
  std::size_t h = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto i = static_cast<std::size_t>(list.i[c]);
    const auto j = static_cast<std::size_t>(list.j[c]);
    const double ax = frame ? 0 : h0[0] * list.shift_x[c] + h0[1] * list.shift_y[c];
    const double ay = frame ? 0 : h0[2] * list.shift_x[c] + h0[3] * list.shift_y[c];
    const double lx = x[j] - x[i] + f[0] * ax + f[1] * ay;
    const double ly = x[n + j] - x[n + i] + f[2] * ax + f[3] * ay;
    const double d2 = lx * lx + ly * ly;
    const auto reference = bound_to_axes ? increment.fixed_branch(c) : pull_back(lx, ly);
    const Quad* zi = &carried_motion_[static_cast<std::size_t>(node[i]) * b];
    const Quad* zj = &carried_motion_[static_cast<std::size_t>(node[j]) * b];
    for (std::size_t k = 0; k < width; ++k) {
      const double dx = zj[0].lane[k] - zi[0].lane[k] + start_change[0].lane[k] * reference[0] +
                        start_change[1].lane[k] * reference[1];
      const double dy = zj[1].lane[k] - zi[1].lane[k] + start_change[2].lane[k] * reference[0] +
                        start_change[3].lane[k] * reference[1];
      start_turn_[c].lane[k] = -(lx * dy - ly * dx) / d2;
      if (hertzian) start_overlap_[c].lane[k] = -(lx * dx + ly * dy) / std::sqrt(d2);
      if (moments) start_spin_[c].lane[k] = zj[2].lane[k] - zi[2].lane[k];
      if (rotating) {
        start_turn_[c].lane[k] +=
            list.lever_i[c] * zi[2].lane[k] + (1 - list.lever_i[c]) * zj[2].lane[k];
      }
    }
    start_force_[c] = {};
    if (moments) start_moment_[c] = {};
    const auto key = std::tie(list.i[c], list.j[c], increment.pairs[c].shift);
    const auto& history = increment.history;
    const auto key_of = [](const ContactHistory& s) { return std::tie(s.i, s.j, s.shift); };
    while (h < history.size() && key_of(history[h]) < key) ++h;
    if (h == history.size() || key_of(history[h]) != key) continue;
    for (std::size_t k = 0; k < width; ++k) {
      start_force_[c].lane[k] = list.weight_of(c) * carried_force_[h].lane[k];
      if (moments) start_moment_[c].lane[k] = list.weight_of(c) * carried_moment_[h].lane[k];
    }
  }
  if (hertzian) rescale_start(increment);
}

bool Sensitivity::solve(Increment& increment, double share, double start_share,
                        Stiffness& stiffness) {
  if (carried_) start_of_history(increment, start_share);
  const auto& space = *increment.problem->space;
  const auto& list = increment.contacts;
  const bool rotating = increment.problem->law->rotating();
  stiffness.assemble(increment, 0);
  const auto touching = stiffness.touching();
  const bool moments = increment.problem->law->moments();
  HistoryChange history;
  if (carried_) history = {start_turn_.data(), start_force_.data()};
  if (carried_ && moments) {
    history.moment = start_moment_.data();
    history.spin = start_spin_.data();
  }
  change_ = change_at(share, space, {});

  const std::size_t b = rotating ? 3 : 2;
  resize_with_room(motion_, increment.node_unknowns());
  right_.assign(increment.node_unknowns(), Quad{});
  add_residual_changes(increment, stiffness, change_, history, right_);
  if (!space.identity) {
    for (std::size_t q = 0; q < increment.nodes(); ++q) {
      for (std::size_t k = 0; k < b; ++k) {
        if ((space.fixed[q] >> k & 1U) != 0) right_[q * b + k] = {};
      }
    }
  }
  if (!stiffness.solve_four(increment, right_, motion_)) return false;

  resize_with_room(changes_, touching.size());
  if (BorderedSystem::needed(space) && !complete(increment, history, stiffness)) return false;
  find_contact_changes(increment, touching, change_, history, motion_, changes_);
  if (moments) {
    resize_with_room(moment_changes_, touching.size());
    find_moment_changes(increment, stiffness, change_, history, motion_, moment_changes_);
  }
  resize_with_room(place_, list.size());
  std::fill(place_.begin(), place_.end(), -1);
  for (std::size_t k = 0; k < touching.size(); ++k) {
    place_[touching[k].index] = static_cast<std::int32_t>(k);
  }
  return true;
}

// What the border adds.
bool Sensitivity::complete(Increment& increment, const HistoryChange& history,
                           Stiffness& stiffness) {
  const auto touching = stiffness.touching();
  if (increment.problem->space->finds_deformation) {
    find_contact_changes(increment, touching, change_, history, motion_, changes_);
  }
  return border_.prepare(increment, stiffness) &&
         border_.complete(increment, touching, changes_, motion_, change_);
}

void Sensitivity::carry(const Increment& increment) {
  const auto& list = increment.contacts;
  const bool moments = increment.problem->law->moments();
  carried_force_.clear();
  carried_moment_.clear();
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (!increment.carries(c)) continue;
    Quad force = changes(c).tangential_force;
    for (double& value : force.lane) value /= list.weight_of(c);
    carried_force_.push_back(force);
    if (!moments) continue;
    Quad moment = moment_changes_[static_cast<std::size_t>(place_[c])];
    for (double& value : moment.lane) value /= list.weight_of(c);
    carried_moment_.push_back(moment);
  }
  keep_room(carried_force_);
  keep_room(carried_moment_);
  carry_motion(increment);
  carried_change_ = change_;
  carried_ = true;
}

void Sensitivity::carry_free(const Increment& increment, double share) {
  change_ = change_at(share, *increment.problem->space, {});
  motion_.assign(increment.node_unknowns(), Quad{});
  carry(increment);
}

// As Increment::carry_start moves it: what is not held goes on from its last start, with the mean of
// the others.
void Sensitivity::carry_motion(const Increment& increment) {
  const auto& node = increment.problem->space->node;
  const std::size_t b = increment.problem->law->rotating() ? 3 : 2;
  if (!carried_) carried_motion_.assign(increment.node_unknowns(), Quad{});
  if (!increment.problem->space->bound_to_axes()) {
    push_forward(increment.deformation, increment.start_deformation, b, carried_motion_);
  }
  increment.find_held(held_);
  for (std::size_t k = 0; k < 2; ++k) {
    const unsigned char bit = k == 0 ? fixed_x : fixed_y;
    Lanes sum{};
    double count = 0;
    for (const int q : node) {
      if ((held_[static_cast<std::size_t>(q)] & bit) == 0) continue;
      const std::size_t at = static_cast<std::size_t>(q) * b + k;
      sum += load(motion_[at].lane) - load(carried_motion_[at].lane);
      ++count;
    }
    const Lanes mean = count > 0 ? sum / count : sum;
    for (std::size_t q = 0; q < increment.nodes(); ++q) {
      const std::size_t at = q * b + k;
      if ((held_[q] & bit) != 0) {
        carried_motion_[at] = motion_[at];
      } else {
        store(carried_motion_[at].lane, load(carried_motion_[at].lane) + mean);
      }
    }
  }
  if (b == 2) return;
  for (std::size_t q = 0; q < increment.nodes(); ++q)
    carried_motion_[q * b + 2] = motion_[q * b + 2];
}

}  // namespace grainlaw
