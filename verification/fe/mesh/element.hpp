// Finite elements of the driver: shape functions and quadrature points of every kind.
#pragma once

#include <Eigen/Dense>

#include <string_view>
#include <vector>

namespace verification {

// q4: bilinear quadrilateral, 2 x 2 Gauss points. q4r: the same with one point, which leaves its two
// hourglass modes without stiffness (see fe/hourglass.hpp). q8: serendipity quadrilateral, 3 x 3
// points. t3: linear triangle, one point. q4fbar: q4 whose points share the area ratio of the centre
// (see fe/mean_volume.hpp).
enum class ElementKind { q4, q4r, q8, t3, q4fbar };

// Coordinates, gradients: one row per node, at most eight.
using NodeRows = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::ColMajor, 8, 2>;
using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;

struct Shape {
  NodeValues value;     // N_a
  NodeRows derivative;  // dN_a/dxi
};

struct LocalPoint {
  Eigen::Vector2d xi;  // quadrilaterals: in [-1, 1]^2; triangles: xi, eta, xi + eta in [0, 1]
  double weight;
};

// Nodes: the corners anticlockwise, then the mid-side nodes in the order of the sides, the first one
// between corners 0 and 1.
struct ElementType {
  std::string_view name;
  int nodes;
  int corners;
  Shape (*shape)(const Eigen::Vector2d& xi);
  std::vector<Eigen::Vector2d> local_nodes;  // xi of the nodes
  std::vector<LocalPoint> points;
};

const ElementType& element_type(ElementKind kind);

// A quadrature point of an element in its reference configuration.
struct QuadPoint {
  NodeRows gradient;  // dN_a/dX_J [1/m]
  double weight;      // reference area it stands for [m2]
  NodeValues shape;   // N_a
};

// nodes [number of nodes of the kind]: reference positions [m].
std::vector<QuadPoint> quad_points(ElementKind kind, const std::vector<Eigen::Vector2d>& nodes);

}  // namespace verification
