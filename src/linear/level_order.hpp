// An order of the nodes of a graph in which neighbours are near each other (Cuthill & McKee 1969).
#pragma once

#include "linear/block_matrix.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Each connected part starts with its first node and goes on level by level. Within a level, nodes follow
// the order of those they were reached from.
class LevelOrder {
 public:
  // Edges are unique, each with first < second.
  void find(std::size_t nodes, std::span<const Edge> edges);

  // Which node has a place, and the place of each node.
  [[nodiscard]] std::span<const std::int32_t> node() const { return node_; }
  [[nodiscard]] std::span<const std::int32_t> place() const { return place_; }

 private:
  void list_neighbours(std::span<const Edge> edges);

  std::vector<std::int32_t> node_, place_, neighbour_;
  std::vector<std::size_t> begin_, next_;
};

}  // namespace grainlaw::core
