// Shape functions, local nodes and integration points of elements.
#pragma once

#include "fe/mesh/element.hpp"

namespace verification {

// Corners of square and cube, then nodes amid edges.
const std::vector<Position>& square_nodes();
const std::vector<Position>& cube_nodes();
// Corners of triangle and tetrahedron, then nodes amid edges.
const std::vector<Position>& triangle_nodes();
const std::vector<Position>& tetrahedron_nodes();

Shape bilinear(const Position& xi);
Shape serendipity(const Position& xi);  // of the square
Shape trilinear(const Position& xi);
Shape serendipity_solid(const Position& xi);
Shape linear_triangle(const Position& xi);
Shape quadratic_triangle(const Position& xi);
Shape quadratic_tetrahedron(const Position& xi);

// Gauss points. 2 x 2 points of the square run anticlockwise, like the corners; others in rows of
// increasing xi.
std::vector<LocalPoint> square_points(int per_direction);
std::vector<LocalPoint> cube_points(int per_direction);
// Points of degree 2: three in the triangle, four in the tetrahedron.
std::vector<LocalPoint> simplex_points(int dimension);

}  // namespace verification
