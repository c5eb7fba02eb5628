#include "frame/frame_geometry.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

bool on_segment(const Point& a, const Point& b, const Point& p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
         std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double ca = orientation(c, d, a);
  const double cb = orientation(c, d, b);
  const double ac = orientation(a, b, c);
  const double ad = orientation(a, b, d);
  if (((ca > 0) != (cb > 0)) && ((ac > 0) != (ad > 0))) return true;
  return (ca == 0 && on_segment(c, d, a)) || (cb == 0 && on_segment(c, d, b)) ||
         (ac == 0 && on_segment(a, b, c)) || (ad == 0 && on_segment(a, b, d));
}

}  // namespace

double orientation(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double signed_area(const std::vector<Point>& polygon) {
  // Coordinates relative to the first corner, so that a distant origin costs no digits.
  double twice = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    twice += orientation(polygon[0], polygon[k - 1], polygon[k]);
  return twice / 2;
}

bool is_simple(const std::vector<Point>& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 2; b < n; ++b) {
      if (a == 0 && b == n - 1) continue;
      if (segments_meet(polygon[a], polygon[a + 1], polygon[b], polygon[(b + 1) % n])) return false;
    }
  return true;
}

bool is_inside(const std::vector<Point>& polygon, const Point& point) {
  bool inside = false;
  for (std::size_t k = 0, last = polygon.size() - 1; k < polygon.size(); last = k++) {
    const Point& a = polygon[last];
    const Point& b = polygon[k];
    if ((a[1] > point[1]) == (b[1] > point[1])) continue;
    // The side crosses the horizontal line through the point: count crossings to its right.
    if ((orientation(a, b, point) > 0) == (b[1] > a[1])) inside = !inside;
  }
  return inside;
}

}  // namespace grainlaw::core
