#include "equilibrium/sensitivity.hpp"

#include "room.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace grainlaw {

namespace {

std::array<double, 2> pull_back(const std::array<double, 4>& f, double x, double y) {
  const double det = f[0] * f[3] - f[1] * f[2];
  return {(f[3] * x - f[1] * y) / det, (f[0] * y - f[2] * x) / det};
}

std::array<double, 3> apply(const std::array<double, 9>& a, double x, double y, double z) {
  return {a[0] * x + a[1] * y + a[2] * z, a[3] * x + a[4] * y + a[5] * z,
          a[6] * x + a[7] * y + a[8] * z};
}

}  // namespace

void Sensitivity::start_of_history(const Increment& increment, double start_share) {
  const auto& list = increment.contacts;
  const auto& node = increment.problem->space->node;
  const auto nodes = increment.nodes();
  const auto n = increment.particles();
  const bool rotating = increment.problem->law->rotating();
  const bool frame = increment.problem->packing->frame.has_value();
  const double* h0 = increment.problem->packing->cell.data();
  const auto& f = increment.start_deformation;
  const double* x = increment.start.data();
  resize_with_room(start_turn_, list.size());
  resize_with_room(start_force_, list.size());
  std::fill(start_force_.begin(), start_force_.end(), std::array<double, 4>{});
  std::size_t h = 0;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto i = static_cast<std::size_t>(list.i[c]);
    const auto j = static_cast<std::size_t>(list.j[c]);
    double ax = frame ? 0 : h0[0] * list.shift_x[c] + h0[1] * list.shift_y[c];
    double ay = frame ? 0 : h0[2] * list.shift_x[c] + h0[3] * list.shift_y[c];
    const double lx = x[j] - x[i] + f[0] * ax + f[1] * ay;
    const double ly = x[n + j] - x[n + i] + f[2] * ax + f[3] * ay;
    const double d2 = lx * lx + ly * ly;
    const auto reference = pull_back(f, lx, ly);
    const auto a = static_cast<std::size_t>(node[i]);
    const auto b = static_cast<std::size_t>(node[j]);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& z = carried_motion_[k];
      double dx = z[b] - z[a];
      double dy = z[nodes + b] - z[nodes + a];
      (k < 2 ? dx : dy) += start_share * reference[k % 2];
      start_turn_[c][k] = -(lx * dy - ly * dx) / d2;
      if (rotating) {
        start_turn_[c][k] +=
            list.lever_i[c] * z[2 * nodes + a] + (1 - list.lever_i[c]) * z[2 * nodes + b];
      }
    }
    const auto key = std::tie(list.i[c], list.j[c], increment.pairs[c].shift);
    const auto& history = increment.history;
    const auto key_of = [](const ContactHistory& s) { return std::tie(s.i, s.j, s.shift); };
    while (h < history.size() && key_of(history[h]) < key) ++h;
    if (h == history.size() || key_of(history[h]) != key) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      start_force_[c][k] = list.weight_of(c) * carried_force_[h][k];
    }
  }
}

bool Sensitivity::solve(Increment& increment, double share, double start_share,
                        Stiffness& stiffness) {
  share_ = share;
  if (carried_) start_of_history(increment, start_share);
  const auto& list = increment.contacts;
  const auto& space = *increment.problem->space;
  const auto& law = *increment.problem->law;
  const auto nodes = increment.nodes();
  const bool rotating = law.rotating();
  for (std::size_t k = 0; k < 4; ++k) {
    motion_[k].assign(increment.unknowns(), 0.0);
    right_[k].assign(increment.unknowns(), 0.0);
  }

  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto point =
        contact_point(list, c, increment.coordinates, increment.particles(), increment.cell, law);
    if (point.status == ContactStatus::open) continue;
    const auto a = static_cast<std::size_t>(space.node[static_cast<std::size_t>(list.i[c])]);
    const auto b = static_cast<std::size_t>(space.node[static_cast<std::size_t>(list.j[c])]);
    for (std::size_t k = 0; k < 4; ++k) {
      // With zero motion: the change under the affine motion and the history alone.
      const auto q = change(increment, c, point, k);
      auto& r = right_[k];
      r[a] -= q.force_x;
      r[nodes + a] -= q.force_y;
      r[b] += q.force_x;
      r[nodes + b] += q.force_y;
      if (!rotating) continue;
      const double stretch = point.normal_x * q.branch_x + point.normal_y * q.branch_y;
      const double couple = point.tangential_force * stretch + point.distance * q.tangential_force;
      r[2 * nodes + a] -= list.lever_i[c] * couple;
      r[2 * nodes + b] -= (1 - list.lever_i[c]) * couple;
    }
  }
  stiffness.assemble(increment, 0);
  stiffness.factorise(increment);
  for (std::size_t k = 0; k < 4; ++k) {
    if (!space.identity) {
      for (std::size_t q = 0; q < nodes; ++q) {
        if (space.fixed[q]) right_[k][q] = right_[k][nodes + q] = 0;
      }
    }
    if (!stiffness.solve(increment, right_[k], motion_[k])) return false;
  }
  return true;
}

Sensitivity::Change Sensitivity::change(const Increment& increment, std::size_t c,
                                        const ContactPoint& point, std::size_t k) const {
  const auto& list = increment.contacts;
  const auto& node = increment.problem->space->node;
  const auto nodes = increment.nodes();
  const auto a = static_cast<std::size_t>(node[static_cast<std::size_t>(list.i[c])]);
  const auto b = static_cast<std::size_t>(node[static_cast<std::size_t>(list.j[c])]);
  const auto& z = motion_[k];
  const auto reference = pull_back(increment.deformation, point.branch_x, point.branch_y);
  Change result{};
  result.branch_x = z[b] - z[a];
  result.branch_y = z[nodes + b] - z[nodes + a];
  (k < 2 ? result.branch_x : result.branch_y) += share_ * reference[k % 2];
  if (point.status == ContactStatus::open) return result;

  const double nx = point.normal_x;
  const double ny = point.normal_y;
  const double normal = nx * result.branch_x + ny * result.branch_y;
  const double tangential = -ny * result.branch_x + nx * result.branch_y;
  double rotation = 0;
  if (increment.problem->law->rotating()) {
    rotation = list.lever_i[c] * z[2 * nodes + a] + (1 - list.lever_i[c]) * z[2 * nodes + b];
  }
  const auto stiffness =
      contact_stiffness(point, list.normal_stiffness[c], list.tangential_stiffness[c],
                        increment.problem->law->friction);
  const auto q = apply(stiffness, normal, tangential, rotation);
  double by_history = 0;
  if (carried_ && point.status == ContactStatus::sticking) {
    by_history =
        start_force_[c][k] - list.tangential_stiffness[c] * point.distance * start_turn_[c][k];
  }
  const double along_t = q[1] + by_history;
  result.force_x = q[0] * nx - along_t * ny;
  result.force_y = q[0] * ny + along_t * nx;
  result.tangential_force = (q[2] - point.tangential_force * normal) / point.distance + by_history;
  return result;
}

void Sensitivity::carry(const Increment& increment) {
  const auto& list = increment.contacts;
  std::vector<std::array<double, 4>>& force = carried_force_;
  force.clear();
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto point = contact_point(list, c, increment.coordinates, increment.particles(),
                                     increment.cell, *increment.problem->law);
    if (!increment.carries(c)) continue;
    std::array<double, 4> value{};
    for (std::size_t k = 0; k < 4; ++k) {
      value[k] = change(increment, c, point, k).tangential_force / list.weight_of(c);
    }
    force.push_back(value);
  }
  keep_room(force);
  carried_motion_ = motion_;
  carried_ = true;
}

}  // namespace grainlaw
