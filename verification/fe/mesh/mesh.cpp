#include "fe/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace verification {

std::vector<Position> Mesh::positions(const std::vector<int>& element) const {
  std::vector<Position> result;
  for (const int node : element) result.push_back(position(node));
  return result;
}

Position Mesh::low() const {
  Position result = nodes.front();
  for (const Position& node : nodes) result = result.cwiseMin(node);
  return result;
}

Position Mesh::high() const {
  Position result = nodes.front();
  for (const Position& node : nodes) result = result.cwiseMax(node);
  return result;
}

namespace {

using Lines = std::array<int, 3>;  // a place in the grid of node lines

// Places of the nodes of every element of a cell, in halves of the cell.
std::vector<std::vector<Lines>> places_in_cell(const ElementType& type) {
  const auto axes = static_cast<std::size_t>(type.dimension);
  std::vector<std::vector<Lines>> parts;
  if (!type.simplex()) {
    parts.emplace_back();
    for (const Position& xi : type.local_nodes) {
      Lines place{};
      for (std::size_t k = 0; k < axes; ++k)
        place[k] = static_cast<int>(std::lround(xi(static_cast<Eigen::Index>(k)))) + 1;
      parts.back().push_back(place);
    }
    return parts;
  }
  // A simplex for every order of the axes: its edges from the first corner reach one axis further.
  std::vector<std::size_t> order(axes);
  std::iota(order.begin(), order.end(), 0);
  do {
    std::vector<Lines> reach;
    Lines corner{};
    for (const std::size_t axis : order) {
      corner[axis] = 2;
      reach.push_back(corner);
    }
    int inversions = 0;
    for (std::size_t a = 0; a < axes; ++a)
      for (std::size_t b = a + 1; b < axes; ++b) inversions += order[a] > order[b] ? 1 : 0;
    // Every second one would be inverted: two of its corners change places.
    if (inversions % 2 == 1) std::swap(reach[axes - 2], reach[axes - 1]);
    parts.emplace_back();
    for (const Position& xi : type.local_nodes) {
      std::array<double, 3> sum{};
      for (std::size_t c = 0; c < axes; ++c)
        for (std::size_t k = 0; k < axes; ++k)
          sum[k] += xi(static_cast<Eigen::Index>(c)) * reach[c][k];
      Lines place{};
      for (std::size_t k = 0; k < axes; ++k) place[k] = static_cast<int>(std::lround(sum[k]));
      parts.back().push_back(place);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return parts;
}

// Names of the two ends of every axis.
std::vector<std::array<const char*, 2>> end_names(int dimension) {
  if (dimension == 2) return {{"left", "right"}, {"bottom", "top"}};
  return {{"left", "right"}, {"front", "back"}, {"bottom", "top"}};
}

// "bottom_left" of a rectangle, "bottom_left_front" of a box.
std::string corner_name(const std::vector<std::string>& ends) {
  std::string name = ends.back();
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) name += '_' + ends[k];
  return name;
}

}  // namespace

Mesh box_mesh(const std::vector<double>& size, const std::vector<int>& divisions,
              ElementKind kind) {
  const ElementType& type = element_type(kind);
  const auto axes = static_cast<std::size_t>(type.dimension);
  const bool quadratic = type.nodes > type.corners;
  const int stride = quadratic ? 2 : 1;  // node lines per cell
  Lines last{};
  for (std::size_t k = 0; k < axes; ++k) last[k] = stride * divisions[k];
  Mesh mesh;
  mesh.kind = kind;
  const auto place = [&](const Lines& at) {
    return static_cast<std::size_t>((at[2] * (last[1] + 1) + at[1]) * (last[0] + 1) + at[0]);
  };
  std::vector<int> number(place(last) + 1, -1);  // -1: no node, as amid a serendipity cell
  std::vector<Lines> lines;                      // of the nodes
  for (int k = 0; k <= last[2]; ++k)
    for (int j = 0; j <= last[1]; ++j)
      for (int i = 0; i <= last[0]; ++i) {
        const Lines at{i, j, k};
        if (quadratic && !type.simplex() && i % 2 + j % 2 + k % 2 > 1) continue;
        number[place(at)] = static_cast<int>(lines.size());
        lines.push_back(at);
        Position position(static_cast<Eigen::Index>(axes));
        for (std::size_t axis = 0; axis < axes; ++axis)
          position(static_cast<Eigen::Index>(axis)) = size[axis] * at[axis] / last[axis];
        mesh.nodes.push_back(position);
      }
  const auto parts = places_in_cell(type);
  for (int k = 0; k < std::max(last[2], 1); k += stride)
    for (int j = 0; j < last[1]; j += stride)
      for (int i = 0; i < last[0]; i += stride)
        for (const std::vector<Lines>& part : parts) {
          std::vector<int> element;
          for (const Lines& in_cell : part)
            element.push_back(
                number[place({i + in_cell[0] * stride / 2, j + in_cell[1] * stride / 2,
                              k + in_cell[2] * stride / 2})]);
          mesh.elements.push_back(element);
        }
  const auto ends = end_names(type.dimension);
  for (std::size_t axis = 0; axis < axes; ++axis)
    for (const std::size_t end : {0U, 1U}) {
      const auto on_end = [&](int node) {
        return lines[static_cast<std::size_t>(node)][axis] == (end == 0 ? 0 : last[axis]);
      };
      for (int node = 0; node < static_cast<int>(lines.size()); ++node)
        if (on_end(node)) mesh.node_sets[ends[axis][end]].push_back(node);
      for (const auto& element : mesh.elements)
        for (const auto& local : type.sides) {
          Side side;
          for (const int a : local) side.push_back(element[static_cast<std::size_t>(a)]);
          if (std::all_of(side.begin(), side.end(), on_end))
            mesh.side_sets[ends[axis][end]].push_back(side);
        }
    }
  for (std::size_t corner = 0; corner < 1U << axes; ++corner) {
    Lines at{};
    std::vector<std::string> names;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const std::size_t end = corner >> axis & 1U;
      at[axis] = end == 0 ? 0 : last[axis];
      names.emplace_back(ends[axis][end]);
    }
    mesh.node_sets[corner_name(names)] = {number[place(at)]};
  }
  return mesh;
}

}  // namespace verification
