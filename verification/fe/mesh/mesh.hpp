// Finite element meshes: nodes, elements of one kind, named sets.
#pragma once

#include "fe/mesh/element.hpp"

#include <Eigen/Dense>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace verification {

// Nodes of an element side: its ends, with the element on the left, then its mid-side node where
// there is one.
using Side = std::vector<int>;

struct Mesh {
  ElementKind kind = ElementKind::q4;
  std::vector<Eigen::Vector2d> nodes;      // reference positions [m]
  std::vector<std::vector<int>> elements;  // in the order of ElementType
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<Side>> side_sets;

  [[nodiscard]] std::vector<Eigen::Vector2d> positions(const std::vector<int>& element) const;
};

// A rectangle of this size [m] with so many cells along x and y. A cell is one quadrilateral, or
// two triangles divided by the diagonal from bottom left to top right. The right triangle comes
// first, as in FreeFEM's `square`. Sets: "left", "right", "bottom", "top", nodes by increasing
// coordinate; corners "bottom_left", "bottom_right", "top_right", "top_left".
Mesh rectangle_mesh(const std::array<double, 2>& size, const std::array<int, 2>& divisions,
                    ElementKind kind);

}  // namespace verification
