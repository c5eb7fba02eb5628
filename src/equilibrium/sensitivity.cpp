#include "equilibrium/sensitivity.hpp"

#include "room.hpp"
#include "simd.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainlaw {

using simd::store;
using Lanes = simd::Lanes<4>;  // of a quad
constexpr std::size_t width = 4;
GRAINLAW_INLINE Lanes load(const double* from) { return simd::load<4>(from); }

namespace {

struct PullBack {
  double a, b, c, d;
  explicit PullBack(const std::array<double, 4>& f) {
    const double det = f[0] * f[3] - f[1] * f[2];
    a = f[3] / det;
    b = -f[1] / det;
    c = -f[2] / det;
    d = f[0] / det;
  }
  [[nodiscard]] GRAINLAW_INLINE std::array<double, 2> operator()(double x, double y) const {
    return {a * x + b * y, c * x + d * y};
  }
};

// What all contacts share, and the arrays they write to.
struct ContactLoop {
  std::span<const TouchingContact> touching;
  PullBack pull_back;
  double share;
  const Quad* start_turn;  // per listed contact, null before the first history
  const Quad* start_force;
  const double* tangential_stiffness;
};

// The change of one contact; `motion` null: under the affine motion and the history alone. Returns
// that of the couple d ft.
template <bool rotating>
GRAINLAW_INLINE Lanes change_of(const ContactLoop& loop, const TouchingContact& contact,
                                const double* motion, Lanes& force_x, Lanes& force_y,
                                Lanes& branch_x, Lanes& branch_y, Lanes& tangential_force) {
  constexpr std::size_t b = rotating ? 3 : 2;
  const auto& point = contact.point;
  const auto reference = loop.pull_back(point.branch_x, point.branch_y);
  const double rx = loop.share * reference[0];
  const double ry = loop.share * reference[1];
  branch_x = Lanes{rx, ry, 0, 0};
  branch_y = Lanes{0, 0, rx, ry};
  Lanes rotation{};
  if (motion != nullptr) {
    const double* zi = motion + contact.node_i * b * width;
    const double* zj = motion + contact.node_j * b * width;
    branch_x += load(zj) - load(zi);
    branch_y += load(zj + width) - load(zi + width);
    if constexpr (rotating) {
      rotation =
          contact.lever_i * load(zi + 2 * width) + (1 - contact.lever_i) * load(zj + 2 * width);
    }
  }
  const double nx = point.normal_x;
  const double ny = point.normal_y;
  const auto& s = contact.stiffness;
  const Lanes normal = nx * branch_x + ny * branch_y;
  const Lanes tangential = nx * branch_y - ny * branch_x;
  const Lanes along_n = s[0] * normal + s[1] * tangential + s[2] * rotation;
  Lanes along_t = s[3] * normal + s[4] * tangential + s[5] * rotation;
  Lanes couple = s[6] * normal + s[7] * tangential + s[8] * rotation;
  if (loop.start_turn != nullptr && point.status != ContactStatus::sliding) {
    const Lanes by_history = load(loop.start_force[contact.index].lane) -
                             loop.tangential_stiffness[contact.index] * point.distance *
                                 load(loop.start_turn[contact.index].lane);
    along_t += by_history;
    couple += point.distance * by_history;
  }
  force_x = nx * along_n - ny * along_t;
  force_y = ny * along_n + nx * along_t;
  tangential_force = (couple - point.tangential_force * normal) / point.distance;
  return couple;
}

template <bool rotating>
GRAINLAW_INLINE void sum_right_sides(const ContactLoop& loop, double* right) {
  constexpr std::size_t b = rotating ? 3 : 2;
  Lanes fx{}, fy{}, bx{}, by{}, ft{};
  for (const auto& contact : loop.touching) {
    const Lanes couple = change_of<rotating>(loop, contact, nullptr, fx, fy, bx, by, ft);
    double* ri = right + contact.node_i * b * width;
    double* rj = right + contact.node_j * b * width;
    store(ri, load(ri) - fx);
    store(ri + width, load(ri + width) - fy);
    store(rj, load(rj) + fx);
    store(rj + width, load(rj + width) + fy);
    if constexpr (rotating) {
      store(ri + 2 * width, load(ri + 2 * width) - contact.lever_i * couple);
      store(rj + 2 * width, load(rj + 2 * width) - (1 - contact.lever_i) * couple);
    }
  }
}

template <bool rotating>
GRAINLAW_INLINE void find_changes(const ContactLoop& loop, const double* motion,
                                  Sensitivity::Changes* changes) {
  for (const auto& contact : loop.touching) {
    Lanes fx{}, fy{}, bx{}, by{}, ft{};
    change_of<rotating>(loop, contact, motion, fx, fy, bx, by, ft);
    store(changes->force_x.lane, fx);
    store(changes->force_y.lane, fy);
    store(changes->branch_x.lane, bx);
    store(changes->branch_y.lane, by);
    store(changes->tangential_force.lane, ft);
    ++changes;
  }
}

GRAINLAW_CLONES void right_sides(const ContactLoop& loop, bool rotating, double* right) {
  rotating ? sum_right_sides<true>(loop, right) : sum_right_sides<false>(loop, right);
}
GRAINLAW_CLONES void all_changes(const ContactLoop& loop, bool rotating, const double* motion,
                                 Sensitivity::Changes* changes) {
  rotating ? find_changes<true>(loop, motion, changes) : find_changes<false>(loop, motion, changes);
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
    const auto reference = pull_back(lx, ly);
    const Quad* zi = &carried_motion_[static_cast<std::size_t>(node[i]) * b];
    const Quad* zj = &carried_motion_[static_cast<std::size_t>(node[j]) * b];
    for (std::size_t k = 0; k < width; ++k) {
      double dx = zj[0].lane[k] - zi[0].lane[k];
      double dy = zj[1].lane[k] - zi[1].lane[k];
      (k < 2 ? dx : dy) += start_share * reference[k % 2];
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
  const ContactLoop loop{touching,
                         PullBack(increment.deformation),
                         share,
                         carried_ ? start_turn_.data() : nullptr,
                         carried_ ? start_force_.data() : nullptr,
                         list.tangential_stiffness.data()};

  const std::size_t b = rotating ? 3 : 2;
  resize_with_room(motion_, increment.unknowns());
  right_.assign(increment.unknowns(), Quad{});
  right_sides(loop, rotating, right_.data()->lane);
  const bool moments = increment.problem->law->moments();
  std::array<Quad, 4> deformation{};
  for (std::size_t k = 0; k < width; ++k) deformation[k].lane[k] = share;
  if (moments) {
    find_moment_changes(increment, deformation, stiffness, {});
    add_moments(stiffness);
  }
  if (!space.identity) {
    for (std::size_t q = 0; q < increment.nodes(); ++q) {
      if (space.fixed[q]) right_[q * b] = right_[q * b + 1] = {};
    }
  }
  if (!stiffness.solve_four(increment, right_, motion_)) return false;

  resize_with_room(changes_, touching.size());
  all_changes(loop, rotating, motion_.data()->lane, changes_.data());
  if (moments) find_moment_changes(increment, deformation, stiffness, motion_);
  resize_with_room(place_, list.size());
  std::fill(place_.begin(), place_.end(), -1);
  for (std::size_t k = 0; k < touching.size(); ++k) {
    place_[touching[k].index] = static_cast<std::int32_t>(k);
  }
  return true;
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
  carried_motion_ = motion_;
  carried_ = true;
}

}  // namespace grainlaw
