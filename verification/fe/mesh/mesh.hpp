// Finite element meshes: nodes, elements of one kind, named sets.
#pragma once

#include "fe/mesh/element.hpp"

#include <Eigen/Dense>

#include <map>
#include <string>
#include <vector>

namespace verification {

// Nodes of an element side, in the order of ElementType::sides.
using Side = std::vector<int>;

struct Mesh {
  ElementKind kind = ElementKind::q4;
  std::vector<Position> nodes;             // reference positions [m]
  std::vector<std::vector<int>> elements;  // in the order of ElementType
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<Side>> side_sets;

  [[nodiscard]] int dimension() const { return element_type(kind).dimension; }
  [[nodiscard]] const Position& position(int node) const {
    return nodes[static_cast<std::size_t>(node)];
  }
  [[nodiscard]] std::vector<Position> positions(const std::vector<int>& element) const;
  // Number of displacement components, and of one of them.
  [[nodiscard]] Eigen::Index dofs() const {
    return dimension() * static_cast<Eigen::Index>(nodes.size());
  }
  [[nodiscard]] Eigen::Index dof(int node, int component) const {
    return dimension() * static_cast<Eigen::Index>(node) + component;
  }
  // Displacement of a node.
  [[nodiscard]] Position moved(int node, const Eigen::VectorXd& displacement) const {
    return displacement.segment(dof(node, 0), dimension());
  }
  // Corners of the smallest box around the body [m].
  [[nodiscard]] Position low() const;
  [[nodiscard]] Position high() const;
};

// A rectangle or box of this size [m] with so many cells along each axis; one corner lies at the
// origin. A cell is one element; two triangles, the right one first, as in FreeFEM's `square`; or
// six tetrahedra around a diagonal. Sets: "left", "right" (x), "front", "back" (y of a box), "bottom",
// "top" (the last axis), nodes by increasing coordinate; corners "bottom_left" ..., of a box
// "bottom_left_front" ...
Mesh box_mesh(const std::vector<double>& size, const std::vector<int>& divisions, ElementKind kind);

}  // namespace verification
