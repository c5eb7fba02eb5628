#include "fe/mesh/element.hpp"

#include <array>
#include <cmath>

namespace verification {
namespace {

// Corners of the square, then mid-sides.
const std::vector<Eigen::Vector2d> square_nodes{{-1, -1}, {1, -1}, {1, 1}, {-1, 1},
                                                {0, -1},  {1, 0},  {0, 1}, {-1, 0}};

Shape bilinear(const Eigen::Vector2d& xi) {
  Shape shape{NodeValues(4), NodeRows(4, 2)};
  for (int a = 0; a < 4; ++a) {
    const Eigen::Vector2d& node = square_nodes[static_cast<std::size_t>(a)];
    const double u = 1 + node.x() * xi.x();
    const double v = 1 + node.y() * xi.y();
    shape.value(a) = 0.25 * u * v;
    shape.derivative.row(a) << 0.25 * node.x() * v, 0.25 * node.y() * u;
  }
  return shape;
}

Shape serendipity(const Eigen::Vector2d& xi) {
  Shape shape{NodeValues(8), NodeRows(8, 2)};
  const double x = xi.x();
  const double y = xi.y();
  for (int a = 0; a < 8; ++a) {
    const double s = square_nodes[static_cast<std::size_t>(a)].x();
    const double t = square_nodes[static_cast<std::size_t>(a)].y();
    if (s == 0) {
      shape.value(a) = 0.5 * (1 - x * x) * (1 + t * y);
      shape.derivative.row(a) << -x * (1 + t * y), 0.5 * t * (1 - x * x);
    } else if (t == 0) {
      shape.value(a) = 0.5 * (1 + s * x) * (1 - y * y);
      shape.derivative.row(a) << 0.5 * s * (1 - y * y), -y * (1 + s * x);
    } else {
      shape.value(a) = 0.25 * (1 + s * x) * (1 + t * y) * (s * x + t * y - 1);
      shape.derivative.row(a) << 0.25 * s * (1 + t * y) * (2 * s * x + t * y),
          0.25 * t * (1 + s * x) * (s * x + 2 * t * y);
    }
  }
  return shape;
}

Shape linear(const Eigen::Vector2d& xi) {
  Shape shape{NodeValues(3), NodeRows(3, 2)};
  shape.value << 1 - xi.x() - xi.y(), xi.x(), xi.y();
  shape.derivative << -1, -1, 1, 0, 0, 1;
  return shape;
}

// Points in rows of increasing xi; 2 x 2 points anticlockwise, like the corners.
std::vector<LocalPoint> square_points(int per_direction) {
  if (per_direction == 1) return {{{0, 0}, 4}};
  std::vector<LocalPoint> points;
  if (per_direction == 2) {
    for (std::size_t a = 0; a < 4; ++a) points.push_back({square_nodes[a] / std::sqrt(3.0), 1});
    return points;
  }
  const std::array<double, 3> abscissa{-std::sqrt(0.6), 0, std::sqrt(0.6)};
  const std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i)
      points.push_back({{abscissa[i], abscissa[j]}, weight[i] * weight[j]});
  return points;
}

}  // namespace

const ElementType& element_type(ElementKind kind) {
  static const std::vector<Eigen::Vector2d> corners(square_nodes.begin(), square_nodes.begin() + 4);
  static const std::array<ElementType, 5> types{{
      {"q4", 4, 4, bilinear, corners, square_points(2)},
      {"q4r", 4, 4, bilinear, corners, square_points(1)},
      {"q8", 8, 4, serendipity, square_nodes, square_points(3)},
      {"t3", 3, 3, linear, {{0, 0}, {1, 0}, {0, 1}}, {{{1.0 / 3, 1.0 / 3}, 0.5}}},
      {"q4fbar", 4, 4, bilinear, corners, square_points(2)},
  }};
  return types[static_cast<std::size_t>(kind)];
}

std::vector<QuadPoint> quad_points(ElementKind kind, const std::vector<Eigen::Vector2d>& nodes) {
  const ElementType& type = element_type(kind);
  std::vector<QuadPoint> points;
  for (const LocalPoint& local : type.points) {
    const Shape shape = type.shape(local.xi);
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();  // dX/dxi
    for (std::size_t a = 0; a < nodes.size(); ++a)
      jacobian += nodes[a] * shape.derivative.row(static_cast<Eigen::Index>(a));
    points.push_back({shape.derivative * jacobian.inverse(), local.weight * jacobian.determinant(),
                      shape.value});
  }
  return points;
}

}  // namespace verification
