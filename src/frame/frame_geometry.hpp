// Plane geometry of polygons, as cutting a frame needs it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grainlaw::core {

using Point = std::array<double, 2>;

// Twice the signed area of the triangle (a, b, c), positive when it turns anticlockwise.
double turn(const Point& a, const Point& b, const Point& c);

// Signed area, positive when numbered anticlockwise.
double signed_area(const std::vector<Point>& polygon);

// No two sides touch but neighbours at their common corner.
bool is_simple(const std::vector<Point>& polygon);

// Whether a point lies inside; of points on a side nothing is promised.
bool is_inside(const std::vector<Point>& polygon, const Point& point);

}  // namespace grainlaw::core
