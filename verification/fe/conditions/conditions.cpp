#include "fe/conditions/conditions.hpp"

#include <algorithm>

namespace verification {
namespace {

// The two nodes farthest apart on a rotating tie.
std::pair<std::size_t, std::size_t> ends(const Tie& tie) {
  const auto [low, high] = std::minmax_element(tie.arms.begin(), tie.arms.end());
  return {static_cast<std::size_t>(low - tie.arms.begin()),
          static_cast<std::size_t>(high - tie.arms.begin())};
}

}  // namespace

Weights hinge_weights(const Tie& tie) {
  if (tie.arms.empty()) return {{tie.nodes.front(), 1.0}};
  const auto [a, b] = ends(tie);
  const double length = tie.arms[b] - tie.arms[a];
  return {{tie.nodes[a], tie.arms[b] / length}, {tie.nodes[b], -tie.arms[a] / length}};
}

Weights angle_weights(const Tie& tie) {
  const auto [a, b] = ends(tie);
  const double length = tie.arms[b] - tie.arms[a];
  return {{tie.nodes[a], -1 / length}, {tie.nodes[b], 1 / length}};
}

}  // namespace verification
