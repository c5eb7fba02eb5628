#include "fe/mesh/element.hpp"

#include "fe/dimension.hpp"
#include "fe/mesh/shapes.hpp"

#include <array>

namespace verification {
namespace {

using Sides = std::vector<std::vector<int>>;

std::vector<Position> first(const std::vector<Position>& nodes, std::size_t count) {
  return {nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(count)};
}

// Adds to every side the nodes amid its edges, which join neighbours in its round of corners.
Sides with_middles(Sides sides, const std::vector<Position>& nodes) {
  const auto place = [&](int node) { return nodes[static_cast<std::size_t>(node)]; };
  for (std::vector<int>& side : sides) {
    const std::size_t corners = side.size(), edges = corners == 2 ? 1 : corners;
    for (std::size_t k = 0; k < edges; ++k) {
      const Position middle = 0.5 * (place(side[k]) + place(side[(k + 1) % corners]));
      for (std::size_t a = 0; a < nodes.size(); ++a)
        if (nodes[a] == middle) side.push_back(static_cast<int>(a));
    }
  }
  return sides;
}

std::array<ElementType, 10> make_types() {
  const auto square = square_nodes(), cube = cube_nodes(), triangle = triangle_nodes(),
             tetrahedron = tetrahedron_nodes();
  const auto corners4 = first(square, 4), corners8 = first(cube, 8), corners3 = first(triangle, 3);
  const Sides edges4{{0, 1}, {1, 2}, {2, 3}, {3, 0}}, edges3{{0, 1}, {1, 2}, {2, 0}};
  const Sides faces6{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                     {2, 3, 7, 6}, {0, 3, 2, 1}, {4, 5, 6, 7}};
  const Sides faces4{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const std::vector<LocalPoint> middle{{Eigen::Vector2d(1.0 / 3, 1.0 / 3), 0.5}};
  const std::vector<int> gmsh20{0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
  const std::vector<int> gmsh10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  using enum ElementKind;
  // name, dimension, nodes, corners, shape, local nodes, points, sides, face, F-bar, VTK, Gmsh
  return {{
      {"q4", 2, 4, 4, bilinear, corners4, square_points(2), edges4, q4, false, 9, 3, {}},
      {"q4r", 2, 4, 4, bilinear, corners4, square_points(1), edges4, q4r, false, 9, 3, {}},
      {"q8",
       2,
       8,
       4,
       serendipity,
       square,
       square_points(3),
       with_middles(edges4, square),
       q8,
       false,
       23,
       16,
       {}},
      {"t3", 2, 3, 3, linear_triangle, corners3, middle, edges3, t3, false, 5, 2, {}},
      {"t6",
       2,
       6,
       3,
       quadratic_triangle,
       triangle,
       simplex_points(2),
       with_middles(edges3, triangle),
       t6,
       false,
       22,
       9,
       {}},
      {"q4fbar", 2, 4, 4, bilinear, corners4, square_points(2), edges4, q4, true, 9, 3, {}},
      {"hex8", 3, 8, 8, trilinear, corners8, cube_points(2), faces6, q4, false, 12, 5, {}},
      {"hex8fbar", 3, 8, 8, trilinear, corners8, cube_points(2), faces6, q4, true, 12, 5, {}},
      {"hex20", 3, 20, 8, serendipity_solid, cube, cube_points(3), with_middles(faces6, cube), q8,
       false, 25, 17, gmsh20},
      {"tet10", 3, 10, 4, quadratic_tetrahedron, tetrahedron, simplex_points(3),
       with_middles(faces4, tetrahedron), t6, false, 24, 11, gmsh10},
  }};
}

}  // namespace

const ElementType& element_type(ElementKind kind) {
  static const std::array<ElementType, 10> types = make_types();
  return types[static_cast<std::size_t>(kind)];
}

std::span<const ElementKind> element_kinds_of(int dimension) {
  using enum ElementKind;
  static constexpr std::array plane{q4fbar, q4, q4r, q8, t3, t6};
  static constexpr std::array solid{hex8fbar, hex8, hex20, tet10};
  if (dimension == 2) return plane;
  return solid;
}

QuadPoint quad_point(const ElementType& type, const std::vector<Position>& nodes,
                     const LocalPoint& local) {
  const Shape shape = type.shape(local.xi);
  return in_dimension(type.dimension, [&]<int D>() -> QuadPoint {
    using Square = Eigen::Matrix<double, D, D>;
    Square jacobian = Square::Zero();  // dX/dxi
    for (std::size_t a = 0; a < nodes.size(); ++a)
      jacobian += nodes[a] * shape.derivative.row(static_cast<Eigen::Index>(a));
    const Square inverse = jacobian.inverse();
    return {shape.derivative * inverse, local.weight * jacobian.determinant(), shape.value};
  });
}

std::vector<QuadPoint> quad_points(ElementKind kind, const std::vector<Position>& nodes) {
  const ElementType& type = element_type(kind);
  std::vector<QuadPoint> points;
  for (const LocalPoint& local : type.points) points.push_back(quad_point(type, nodes, local));
  return points;
}

LocalPoint centre(const ElementType& type) {
  const double xi = type.simplex() ? 1.0 / (type.dimension + 1) : 0;
  return {Position::Constant(type.dimension, xi), 0};
}

}  // namespace verification
