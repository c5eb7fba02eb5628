// Finite elements: shape functions and quadrature points of every kind.
#pragma once

#include <Eigen/Dense>

#include <string_view>
#include <vector>

namespace verification {

// Kinds of elements:
//   q4      bilinear quadrilateral, 2 x 2 Gauss points;
//   q4r     bilinear quadrilateral, one point and two hourglass modes (fe/hourglass.hpp);
//   q8      serendipity quadrilateral, 3 x 3 points;
//   t3      linear triangle, one point;
//   q4fbar  q4 whose points share the area ratio of the centre (fe/mean_volume.hpp).
enum class ElementKind { q4, q4r, q8, t3, q4fbar };

// Coordinates or gradients: one row per node, at most eight.
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

// Nodes: corners anticlockwise, then mid-side nodes by sides, the first between corners 0 and 1.
struct ElementType {
  std::string_view name;
  int nodes;
  int corners;
  Shape (*shape)(const Eigen::Vector2d& xi);
  std::vector<Eigen::Vector2d> local_nodes;  // xi of the nodes
  std::vector<LocalPoint> points;
};

const ElementType& element_type(ElementKind kind);

// A quadrature point in the reference configuration of its element.
struct QuadPoint {
  NodeRows gradient;  // dN_a/dX_J [1/m]
  double weight;      // reference area [m2]
  NodeValues shape;   // N_a
};

// Quadrature points of an element with these nodes [number of nodes of the kind], reference
// positions [m].
std::vector<QuadPoint> quad_points(ElementKind kind, const std::vector<Eigen::Vector2d>& nodes);

}  // namespace verification
