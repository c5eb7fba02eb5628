// Finite element meshes: nodes, elements of one kind, named sets.
#pragma once

#include "fe/mesh/element.hpp"

#include <Eigen/Dense>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace verification {

// Nodes of an element side: its ends, the element on the left of the way from the first to the
// second, then the node in its middle where the element has one.
using Side = std::vector<int>;

struct Mesh {
  ElementKind kind = ElementKind::q4;
  std::vector<Eigen::Vector2d> nodes;      // reference positions [m]
  std::vector<std::vector<int>> elements;  // in the order of ElementType
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<Side>> side_sets;

  [[nodiscard]] std::vector<Eigen::Vector2d> positions(const std::vector<int>& element) const;
};

// size [m] and number of cells along x and y. A cell is one quadrilateral, or two triangles on either
// side of its diagonal from bottom left to top right: the one on the right first, as FreeFEM's
// `square` has them. Sets: "left", "right", "bottom", "top", nodes by increasing coordinate; and the
// corner nodes "bottom_left", "bottom_right", "top_right", "top_left".
Mesh rectangle_mesh(const std::array<double, 2>& size, const std::array<int, 2>& divisions,
                    ElementKind kind);

}  // namespace verification
