// Finite elements: one table of all that depends on their kind.
#pragma once

#include <Eigen/Dense>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace verification {

// Kinds of elements:
//   q4        bilinear quadrilateral, 2 x 2 Gauss points;
//   q4r       bilinear quadrilateral, one point and two hourglass modes (fe/hourglass.hpp);
//   q8        serendipity quadrilateral, 3 x 3 points;
//   t3        linear triangle, one point;
//   t6        quadratic triangle, three points;
//   q4fbar    q4 whose points share the area ratio of the centre (fe/mean_volume.hpp);
//   hex8      trilinear hexahedron, 2 x 2 x 2 points;
//   hex8fbar  hex8 whose points share the volume ratio of the centre;
//   hex20     serendipity hexahedron, 3 x 3 x 3 points;
//   tet10     quadratic tetrahedron, four points.
enum class ElementKind { q4, q4r, q8, t3, t6, q4fbar, hex8, hex8fbar, hex20, tet10 };

// Position or displacement of two or three components.
using Position = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;
// Gradients: one row per node, one column per axis; values: one per node.
using NodeRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 20, 3>;
using NodeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 20, 1>;

struct Shape {
  NodeValues value;     // N_a
  NodeRows derivative;  // dN_a/dxi
};

struct LocalPoint {
  Position
      xi;  // squares and cubes: in [-1, 1]; triangles and tetrahedra: components and sum in [0, 1]
  double weight;
};

// Nodes: corners, then those amid edges, in the order of VTK. Corners of plane elements run
// anticlockwise, edges from corner 0 on.
struct ElementType {
  std::string_view name;
  int dimension;
  int nodes;
  int corners;
  Shape (*shape)(const Position& xi);
  std::vector<Position> local_nodes;  // xi of the nodes
  std::vector<LocalPoint> points;
  // Nodes of every side: a line's with the element on the left, a face's anticlockwise from outside.
  // Corners come first. Faces of solids are elements of kind `face`.
  std::vector<std::vector<int>> sides;
  ElementKind face;
  bool mean_volume;             // F-bar
  std::uint8_t vtk;             // cell type
  int gmsh;                     // element type
  std::vector<int> gmsh_order;  // nodes in the order of Gmsh; empty: the same

  [[nodiscard]] bool simplex() const { return corners == dimension + 1; }
};

const ElementType& element_type(ElementKind kind);

// All kinds of a dimension. The first one is the default, and the first of a Gmsh type that of a file.
std::span<const ElementKind> element_kinds_of(int dimension);

// A point in the reference configuration of its element.
struct QuadPoint {
  NodeRows gradient;  // dN_a/dX_J [1/m]
  double weight;      // reference area [m2] or volume [m3]
  NodeValues shape;   // N_a
};

// A point of an element with these nodes [number of nodes of the kind], reference positions [m].
QuadPoint quad_point(const ElementType& type, const std::vector<Position>& nodes,
                     const LocalPoint& local);
// All its integration points.
std::vector<QuadPoint> quad_points(ElementKind kind, const std::vector<Position>& nodes);

// The middle of every element, with the weight of none.
LocalPoint centre(const ElementType& type);

}  // namespace verification
