#include "equilibrium/rolling_mechanisms.hpp"

#include "base/capacity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainlaw::core {

bool RollingMechanisms<2>::possible(const Problem<2>& problem) {
  return problem.law->rotating() && !problem.law->moments() && problem.space->identity;
}

// Finds the root of the node's tree and shortens the path to it.
RollingMechanisms<2>::Member RollingMechanisms<2>::member(std::size_t node) {
  Member result{node, 1};
  while (parent_[result.cluster] != result.cluster) {
    result.sense *= sense_[result.cluster];
    result.cluster = parent_[result.cluster];
  }
  double sense = result.sense;
  while (parent_[node] != node) {
    const std::size_t next = parent_[node];
    const double own = sense_[node];
    parent_[node] = result.cluster;
    sense_[node] = sense;
    sense *= own;
    node = next;
  }
  return result;
}

void RollingMechanisms<2>::find(const Increment<2>& increment,
                                std::span<const TouchingContact<2>> touching) {
  const auto& list = increment.contacts();
  const auto& law = *increment.problem().law;
  const auto nodes = increment.problem().nodes();
  for (auto* column : {&sense_, &rotation_}) resize_with_capacity(*column, nodes);
  resize_with_capacity(parent_, nodes);
  resize_with_capacity(locked_, nodes);
  resize_with_capacity(wanted_, nodes);
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  std::fill(sense_.begin(), sense_.end(), 1.0);
  std::fill(rotation_.begin(), rotation_.end(), 0.0);
  for (auto* column : {&locked_, &wanted_}) {
    std::fill(column->begin(), column->end(), static_cast<unsigned char>(0));
  }
  // Capacities are upper bounds, because these numbers vary more than that of the contacts.
  reserve_with_capacity(sliding_, touching.size());
  reserve_with_capacity(sides_, 2 * touching.size());
  reserve_with_capacity(kinks_, 2 * touching.size());
  sliding_.clear();
  for (const auto& contact : touching) {
    const std::size_t c = contact.index;
    const auto& point = contact.point;
    if (point.status == ContactStatus::sliding) {
      const double overlap = list.rest_of(c) - point.distance;
      const double kt = list.tangential_stiffness[c] * stiffness_scale(overlap, law);
      const double start = list.start_force[0][c] * start_scale(overlap, law);
      sliding_.push_back({start - kt * point.distance * point.slip_angle,
                          law.friction * point.normal_force, kt,
                          point.distance * list.inverse_reach[c], contact.node_i, contact.node_j});
      continue;
    }
    const Member a = member(contact.node_i);
    const Member b = member(contact.node_j);
    if (a.cluster == b.cluster) {
      if (a.sense == b.sense) locked_[a.cluster] = 1;
      continue;
    }
    parent_[b.cluster] = a.cluster;
    sense_[b.cluster] = -a.sense * b.sense;
    locked_[a.cluster] |= locked_[b.cluster];
  }
}

void RollingMechanisms<2>::list_sides() {
  sides_.clear();
  for (std::size_t k = 0; k < sliding_.size(); ++k) {
    const Sliding& contact = sliding_[k];
    const Member a = member(contact.node_i);
    const Member b = member(contact.node_j);
    const auto add = [&](std::size_t cluster, double senses) {
      if (locked_[cluster] == 0 && senses != 0) {
        sides_.push_back({cluster, k, contact.stretch * senses});
      }
    };
    if (a.cluster == b.cluster) {
      add(a.cluster, a.sense + b.sense);
    } else {
      add(a.cluster, a.sense);
      add(b.cluster, b.sense);
    }
  }
  std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
    return a.cluster != b.cluster ? a.cluster < b.cluster : a.contact < b.contact;
  });
}

// Force of the sliding contacts along the rotation [N].
double RollingMechanisms<2>::force(std::span<const Side> sides) const {
  double sum = 0;
  for (const Side& side : sides) {
    const Sliding& contact = sliding_[side.contact];
    sum -= side.rate * std::clamp(contact.trial, -contact.bound, contact.bound);
  }
  return sum;
}

// Rotation [m] that cancels the force, which falls linearly from kink to kink.
double RollingMechanisms<2>::balance(std::span<const Side> sides, double force) {
  kinks_.clear();
  const double way = force > 0 ? 1 : -1;
  for (const Side& side : sides) {
    const Sliding& contact = sliding_[side.contact];
    const double by_rotation = way * contact.stiffness * side.rate;  // change of the trial force
    if (by_rotation == 0) continue;
    const auto [sticks, slides] = std::minmax({(-contact.bound - contact.trial) / by_rotation,
                                               (contact.bound - contact.trial) / by_rotation});
    if (slides <= 0) continue;
    const double stiffness = std::abs(by_rotation * side.rate);
    kinks_.push_back({std::max(sticks, 0.0), stiffness});
    kinks_.push_back({slides, -stiffness});
  }
  std::sort(kinks_.begin(), kinks_.end(),
            [](const Kink& a, const Kink& b) { return a.rotation < b.rotation; });
  double left = std::abs(force);
  double rotation = 0;
  double stiffness = 0;
  for (const Kink& kink : kinks_) {
    const double lost = stiffness * (kink.rotation - rotation);
    if (lost >= left) return way * (rotation + left / stiffness);
    left -= lost;
    rotation = kink.rotation;
    stiffness += kink.stiffness;
  }
  return 0;  // rounding: no slip is left to undo
}

void RollingMechanisms<2>::regularise(const Increment<2>& increment,
                                      Stiffness<2>& stiffness) const {
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    if (parent_[q] == q && locked_[q] == 0) stiffness.regularise_rotation(increment, q);
  }
}

void RollingMechanisms<2>::see(const Increment<2>& increment, std::span<const double> step,
                               double least) {
  forget(increment);
  const std::size_t n = increment.problem().nodes();
  for (std::size_t q = 0; q < n; ++q) {
    if (parent_[q] != q || locked_[q] != 0) continue;
    const double moment = increment.masses().of_unknowns()[2 * n + q] * step[2 * n + q];
    if (std::abs(moment) > least * increment.motion().node_radius()[q]) seen_[q] = 1;
  }
}

void RollingMechanisms<2>::forget(const Increment<2>& increment) {
  resize_with_capacity(seen_, increment.problem().nodes());
  std::fill(seen_.begin(), seen_.end(), static_cast<unsigned char>(0));
}

bool RollingMechanisms<2>::rotate(Increment<2>& increment, double least) {
  bool any = false;
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    if (seen_[q] == 0) continue;
    seen_[q] = 0;
    wanted_[member(q).cluster] = 1;
    any = true;
  }
  if (!any) return false;
  list_sides();
  bool rotated = false;
  for (std::size_t first = 0, last = 0; first < sides_.size(); first = last) {
    const std::size_t cluster = sides_[first].cluster;
    while (last < sides_.size() && sides_[last].cluster == cluster) ++last;
    const auto sides = std::span(sides_).subspan(first, last - first);
    const double moment = force(sides);
    if (wanted_[cluster] == 0 || !(std::abs(moment) > least)) continue;
    const double rotation = balance(sides, moment);
    rotated = rotated || rotation != 0;
    rotation_[cluster] = rotation;
    for (const Side& side : sides) {
      Sliding& contact = sliding_[side.contact];
      contact.trial += contact.stiffness * side.rate * rotation;
    }
  }
  if (!rotated) return false;
  auto& motion = increment.motion();
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    const Member own = member(q);
    motion.coordinate(2, q) += own.sense * rotation_[own.cluster] / motion.node_radius()[q];
  }
  return true;
}

}  // namespace grainlaw::core
