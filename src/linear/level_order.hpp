// Order of the nodes of a graph with neighbours near each other [cuthill1969].
#pragma once

#include "linear/block_matrix.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Order by levels. Each connected part starts with its first node. Nodes of a level follow the
// order of the nodes they were reached from.
class LevelOrder {
 public:
  // Finds the order; edges are unique, each with first < second.
  void find(std::size_t nodes, std::span<const Edge> edges);

  // Node at each index of the order, and index of each node.
  [[nodiscard]] std::span<const std::int32_t> node() const { return node_; }
  [[nodiscard]] std::span<const std::int32_t> place() const { return place_; }

 private:
  void list_neighbours(std::span<const Edge> edges);

  std::vector<std::int32_t> node_, place_, neighbour_;
  std::vector<std::size_t> begin_, next_;
};

}  // namespace grainlaw::core
