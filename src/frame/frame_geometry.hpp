// Plane geometry of polygons, for cutting frames.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grainlaw::core {

using Point = std::array<double, 2>;

// Twice the signed area of the triangle (a, b, c), positive when anticlockwise.
double orientation(const Point& a, const Point& b, const Point& c);

// Signed area, positive when anticlockwise.
double signed_area(const std::vector<Point>& polygon);

// Whether no two sides touch except neighbours at their common corner.
bool is_simple(const std::vector<Point>& polygon);

// Whether a point lies inside; undefined for points on a side.
bool is_inside(const std::vector<Point>& polygon, const Point& point);

}  // namespace grainlaw::core
