// Anchors of the average constraints of a frame: stiffness that regularises the matrix.
#include "base/capacity.hpp"
#include "tangent/stiffness.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

// Calls visit(number of the link, direction, index of the first node, of the second) for all pairs
// of anchors.
template <class Visit>
void for_each_link(const BoundarySpace<2>& space, Visit&& visit) {
  std::size_t link = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& node = space.average[i].node;
    const std::size_t stride = anchor_stride(space.average[i]);
    for (std::size_t a = 0; a < node.size(); a += stride) {
      for (std::size_t b = a + stride; b < node.size(); b += stride) visit(link++, i, a, b);
    }
  }
}

}  // namespace

// Links enter the pairs with negative numbers, contacts with their index.
template <>
void Stiffness<2>::link_anchors(const Increment<2>& increment) {
  const auto& space = *increment.problem().space;
  std::size_t links = 0;
  for_each_link(space, [&](std::size_t link, std::size_t i, std::size_t a, std::size_t b) {
    const auto& node = space.average[i].node;
    pairs_.push_back({std::minmax(node[a], node[b]), -static_cast<std::int32_t>(link) - 1});
    ++links;
  });
  resize_with_capacity(edge_of_link_, links);
}

template <>
void Stiffness<2>::add_anchors(const Increment<2>& increment) {
  const auto& space = *increment.problem().space;
  const double kn = increment.masses().mean_stiffness();
  std::array<double, 2> mean{};
  const auto product = [&](const auto& r, const auto& s) {
    return kn * ((r[0] - mean[0]) * (s[0] - mean[0]) + (r[1] - mean[1]) * (s[1] - mean[1]));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [node, row, rows] = space.average[i];
    if (rows == 0) continue;
    mean = anchor_mean(space.average[i]);
    for (std::size_t a = 0; a < node.size(); a += anchor_stride(space.average[i])) {
      matrix_.block(static_cast<std::size_t>(node[a]))[i].lane[i] += product(row[a], row[a]);
    }
  }
  for_each_link(space, [&](std::size_t link, std::size_t i, std::size_t a, std::size_t b) {
    const auto& row = space.average[i].row;
    if (a == 0) mean = anchor_mean(space.average[i]);
    const auto edge = static_cast<std::size_t>(edge_of_link_[link]);
    const double value = product(row[a], row[b]);
    matrix_.block(matrix_.upper(edge))[i].lane[i] += value;
    matrix_.block(matrix_.lower(edge))[i].lane[i] += value;
  });
}

}  // namespace grainlaw::core
