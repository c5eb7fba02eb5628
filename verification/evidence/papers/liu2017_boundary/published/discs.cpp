#include "evidence/papers/liu2017_boundary/published/discs.hpp"

#include "dynamics/specimen.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace verification {

PublishedValues values_of_irregular_packings() {
  PublishedValues values;
  values.deformation_tolerance = 1e-1;
  values.gain_force_of_t = 5;
  values.gain_deformation = 2e-6;
  return values;
}

PublishedDiscs::PublishedDiscs(const std::string& description, const std::string& base,
                               double friction)
    : friction_(friction) {
  const auto material = grainlaw::core::material_of_discs(description, base, base);
  const auto& packing = material->packing;
  const std::size_t n = packing.size();
  radius_ = packing.radius;
  thickness_ = packing.thickness;
  kn_ = material->law.normal_stiffness;
  ks_ = material->law.ratio * kn_;
  for (const double r : radius_)
    mass_.push_back(packing.density * std::numbers::pi * r * r * thickness_);
  const auto& x = material->initial.coordinates;
  for (std::size_t c = 0; c < 2; ++c)
    at_[c].assign(x.begin() + static_cast<std::ptrdiff_t>(c * n),
                  x.begin() + static_cast<std::ptrdiff_t>((c + 1) * n));
  at_[2].assign(n, 0);
  velocity_ = {std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  force_ = velocity_;
  last_ = at_;
  const auto& undeformed = packing.frame->reference;
  reference_ = undeformed.empty() ? packing.position : undeformed;
  on_frame_.assign(n, 0);
  for (std::size_t q = 0; q < packing.frame->boundary.size(); ++q) {
    frame_.push_back(static_cast<std::size_t>(packing.frame->boundary[q]));
    area_.push_back(packing.frame->area[q]);
    on_frame_[frame_.back()] = 1;
    volume_ +=
        0.5 * (reference_[frame_[q]] * area_[q][0] + reference_[n + frame_[q]] * area_[q][1]);
  }
  for (const int other : packing.frame->partner) {
    const auto& ring = packing.frame->boundary;
    const auto found = std::find(ring.begin(), ring.end(), other);
    partner_.push_back(other < 0 ? -1 : static_cast<int>(found - ring.begin()));
  }
  skin_ = 0.1 * mean_radius();
  find_pairs();
  std::map<std::array<std::size_t, 2>, double> given;
  for (const auto& contact : material->initial.contacts) {
    const auto i = static_cast<std::size_t>(contact.i), j = static_cast<std::size_t>(contact.j);
    given[{std::min(i, j), std::max(i, j)}] = contact.tangential_force[0];
  }
  for (Pair& pair : pairs_)
    if (const auto found = given.find({pair.i, pair.j}); found != given.end())
      pair = {pair.i, pair.j, true, found->second, -found->second / ks_};
  update_forces();
}

double PublishedDiscs::mean_radius() const {
  double sum = 0;
  for (const double r : radius_) sum += r;
  return sum / static_cast<double>(size());
}

void PublishedDiscs::find_pairs() {
  std::map<std::array<std::size_t, 2>, Pair> before;
  for (const Pair& pair : pairs_)
    if (pair.touching) before[{pair.i, pair.j}] = pair;
  pairs_.clear();
  for (std::size_t i = 0; i < size(); ++i)
    for (std::size_t j = i + 1; j < size(); ++j) {
      const double reach = radius_[i] + radius_[j] + skin_;
      const double dx = at_[0][j] - at_[0][i], dy = at_[1][j] - at_[1][i];
      if (dx * dx + dy * dy > reach * reach) continue;
      const auto known = before.find({i, j});
      pairs_.push_back(known != before.end() ? known->second : Pair{i, j, false, 0, 0});
    }
  found_at_ = at_[0];
  found_at_.insert(found_at_.end(), at_[1].begin(), at_[1].end());
}

void PublishedDiscs::update_forces() {
  const std::size_t n = size();
  double moved = 0;
  for (std::size_t p = 0; p < n; ++p)
    moved = std::max(
        {moved, std::abs(at_[0][p] - found_at_[p]), std::abs(at_[1][p] - found_at_[n + p])});
  if (moved > 0.3 * skin_) find_pairs();
  for (auto& component : force_) std::fill(component.begin(), component.end(), 0.0);
  potential_ = contact_force_ = 0;
  double touching = 0;
  for (Pair& pair : pairs_) {
    const std::size_t i = pair.i, j = pair.j;
    const double dx = at_[0][j] - at_[0][i], dy = at_[1][j] - at_[1][i];
    const double sum = radius_[i] + radius_[j], square = dx * dx + dy * dy;
    if (square >= sum * sum) {
      pair = {i, j, false, 0, 0};
      continue;
    }
    const double length = std::sqrt(square), nx = dx / length, ny = dy / length;
    const double normal = kn_ * (sum - length);
    const double slip = (last_[0][i] - at_[0][i] + at_[0][j] - last_[0][j]) * -ny +
                        (last_[1][i] - at_[1][i] + at_[1][j] - last_[1][j]) * nx -
                        radius_[i] * (at_[2][i] - last_[2][i]) -
                        radius_[j] * (at_[2][j] - last_[2][j]);
    pair.touching = true;
    pair.whole += slip;
    pair.tangential =
        std::clamp(pair.tangential - ks_ * slip, -friction_ * normal, friction_ * normal);
    const double fx = normal * nx - pair.tangential * ny, fy = normal * ny + pair.tangential * nx;
    force_[0][j] += fx, force_[1][j] += fy, force_[2][j] -= radius_[j] * pair.tangential;
    force_[0][i] -= fx, force_[1][i] -= fy, force_[2][i] -= radius_[i] * pair.tangential;
    potential_ += 0.5 * normal * normal / kn_ + 0.5 * ks_ * pair.whole * pair.whole;
    contact_force_ += normal;
    ++touching;
  }
  contact_force_ /= std::max(touching, 1.0);
  last_ = at_;
}

double PublishedDiscs::critical_step() const {
  return std::sqrt(*std::min_element(mass_.begin(), mass_.end()) / kn_);
}

double PublishedDiscs::kinetic() const {
  double sum = 0;
  for (std::size_t p = 0; p < size(); ++p)
    sum += 0.5 * mass_[p] *
           (velocity_[0][p] * velocity_[0][p] + velocity_[1][p] * velocity_[1][p] +
            0.5 * radius_[p] * radius_[p] * velocity_[2][p] * velocity_[2][p]);
  return sum;
}

void PublishedDiscs::move(Rule rule, double dt, double damping) {
  for (std::size_t p = 0; p < size(); ++p)
    for (std::size_t c = 0; c < 3; ++c) {
      if (on_frame_[p] != 0 && (c < 2 || rule != Rule::T)) continue;
      const double mass = c < 2 ? mass_[p] : 0.5 * mass_[p] * radius_[p] * radius_[p];
      double& v = velocity_[c][p];
      const double f = force_[c][p];
      v += dt * (v != 0 ? f - damping * std::copysign(std::abs(f), v) : f) / mass;
      at_[c][p] += dt * v;
    }
  ++steps_;
}

bool PublishedDiscs::relax(Rule rule, const PublishedValues& values) {
  constexpr int most = 200000;
  int below = 0;
  for (int k = 0; k < most; ++k) {
    update_forces();
    below = kinetic() <= values.energy_ratio * potential_ ? below + 1 : 0;
    if (potential_ == 0 || !std::isfinite(potential_)) return false;
    if (below >= values.steps_below) return true;
    move(rule, values.time_step, values.damping);
  }
  return false;
}

bool PublishedDiscs::relax_tightly(Rule rule, double tolerance) {
  constexpr int most = 400000;
  const double dt = 0.3 * critical_step();
  for (int k = 0; k < most; ++k) {
    update_forces();
    if (contact_force_ == 0 || !std::isfinite(potential_)) return false;
    if (k % 20 == 0 && unbalanced() < tolerance) return true;
    move(rule, dt, PublishedValues().damping);
  }
  return false;
}

double PublishedDiscs::unbalanced() const {
  double largest = 0;
  for (std::size_t p = 0; p < size(); ++p)
    if (on_frame_[p] == 0)
      largest = std::max({largest, std::abs(force_[0][p]), std::abs(force_[1][p]),
                          std::abs(force_[2][p]) / radius_[p]});
  return largest / contact_force_;
}

double PublishedDiscs::mean_force() const { return contact_force_; }

double PublishedDiscs::stored(bool whole) const {
  if (whole) return potential_;
  double sum = 0;
  for (const Pair& pair : pairs_) {
    if (!pair.touching) continue;
    const double length =
        std::hypot(at_[0][pair.j] - at_[0][pair.i], at_[1][pair.j] - at_[1][pair.i]);
    const double overlap = radius_[pair.i] + radius_[pair.j] - length;
    sum += 0.5 * kn_ * overlap * overlap + 0.5 * pair.tangential * pair.tangential / ks_;
  }
  return sum;
}

}  // namespace verification
