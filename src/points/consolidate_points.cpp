#include "points/consolidate_points.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace grainlaw::core {

namespace {

std::vector<std::byte> bytes_of(const IntegrationPoint& point) {
  std::vector<std::byte> bytes(point.state.saved_size());
  point.state.save(bytes);
  return bytes;
}

}  // namespace

SharedConsolidation::SharedConsolidation(PointSpan points, const double* sigma)
    : leader_of(points.size()) {
  struct Led {
    std::size_t leader;
    std::vector<std::byte> bytes;
  };
  std::map<std::vector<double>, std::vector<Led>> by_stress;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const IntegrationPoint& point = *points[k];
    const auto square = static_cast<std::size_t>(point.state.dimension() * point.state.dimension());
    std::vector<Led>& same_stress = by_stress[{sigma + k * square, sigma + (k + 1) * square}];
    std::vector<std::byte> bytes = bytes_of(point);
    const auto same = std::find_if(same_stress.begin(), same_stress.end(), [&](const Led& led) {
      return point.state.shares_material(leaders[led.leader].state) && bytes == led.bytes;
    });
    if (same != same_stress.end()) {
      leader_of[k] = same->leader;
      continue;
    }
    leader_of[k] = leaders.size();
    same_stress.push_back({leaders.size(), std::move(bytes)});
    first.push_back(k);
    leaders.push_back(point);
    leaders.back().committed_tangent = leaders.back().trial_tangent = {};
  }
}

std::vector<IntegrationPoint*> SharedConsolidation::pointers() {
  std::vector<IntegrationPoint*> all;
  for (IntegrationPoint& leader : leaders) all.push_back(&leader);
  return all;
}

std::vector<IntegrationPoint> SharedConsolidation::copies() const {
  std::vector<IntegrationPoint> copies;
  copies.reserve(leader_of.size());
  for (const std::size_t leader : leader_of) copies.push_back(leaders[leader]);
  return copies;
}

}  // namespace grainlaw::core
