#include "linear/level_order.hpp"

#include "base/capacity.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw::core {

namespace {

std::size_t at(std::int32_t node) { return static_cast<std::size_t>(node); }

}  // namespace

void LevelOrder::list_neighbours(std::span<const Edge> edges) {
  std::fill(begin_.begin(), begin_.end(), 0);
  for (const auto& [p, q] : edges) {
    ++begin_[at(p) + 1];
    ++begin_[at(q) + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::copy_n(begin_.begin(), next_.size(), next_.begin());
  resize_with_capacity(neighbour_, 2 * edges.size());
  for (const auto& [p, q] : edges) {
    neighbour_[next_[at(p)]++] = q;
    neighbour_[next_[at(q)]++] = p;
  }
}

void LevelOrder::find(std::size_t nodes, std::span<const Edge> edges) {
  resize_with_capacity(begin_, nodes + 1);
  resize_with_capacity(next_, nodes);
  list_neighbours(edges);
  resize_with_capacity(place_, nodes);
  std::fill(place_.begin(), place_.end(), -1);
  node_.clear();
  reserve_with_capacity(node_, nodes);
  const auto put = [this](std::size_t q) {
    if (place_[q] >= 0) return;
    place_[q] = static_cast<std::int32_t>(node_.size());
    node_.push_back(static_cast<std::int32_t>(q));
  };
  std::size_t seen = 0;
  for (std::size_t first = 0; first < nodes; ++first) {
    put(first);
    for (; seen < node_.size(); ++seen) {
      const std::size_t q = at(node_[seen]);
      for (std::size_t k = begin_[q]; k < begin_[q + 1]; ++k) put(at(neighbour_[k]));
    }
  }
}

}  // namespace grainlaw::core
