#include "fe/mesh/shapes.hpp"

#include <array>
#include <cmath>

namespace verification {
namespace {

Position at(double x, double y) { return Eigen::Vector2d(x, y); }
Position at(double x, double y, double z) { return Eigen::Vector3d(x, y, z); }

// Middles of the edges between corners.
std::vector<Position> with_middles(std::vector<Position> corners,
                                   std::initializer_list<std::array<std::size_t, 2>> edges) {
  std::vector<Position> nodes = corners;
  for (const auto& [a, b] : edges) nodes.push_back(0.5 * (corners[a] + corners[b]));
  return nodes;
}

// Product over the axes of 1 + s x, without up to two of them.
double product(const Position& node, const Position& xi, Eigen::Index without,
               Eigen::Index nor = -1) {
  double result = 1;
  for (Eigen::Index k = 0; k < xi.size(); ++k)
    if (k != without && k != nor) result *= 1 + node(k) * xi(k);
  return result;
}

// Quadratic functions of the barycentric coordinates of corners.
Shape quadratic_simplex(const Position& xi, const std::vector<Position>& nodes) {
  const Eigen::Index axes = xi.size();
  const auto count = static_cast<Eigen::Index>(nodes.size());
  Shape shape{NodeValues(count), NodeRows(count, axes)};
  NodeValues share(axes + 1);
  share << 1 - xi.sum(), xi;
  NodeRows slope(axes + 1, axes);
  slope << Eigen::RowVectorXd::Constant(axes, -1), Eigen::MatrixXd::Identity(axes, axes);
  for (Eigen::Index a = 0; a < count; ++a) {
    const Position& place = nodes[static_cast<std::size_t>(a)];
    NodeValues of_node(axes + 1);
    of_node << 1 - place.sum(), place;
    Eigen::Index first = 0, second = 0;  // corners with a share of the node
    of_node.maxCoeff(&first);
    of_node(first) = 0;
    if (of_node.maxCoeff(&second) > 0) {
      shape.value(a) = 4 * share(first) * share(second);
      shape.derivative.row(a) =
          4 * (share(first) * slope.row(second) + share(second) * slope.row(first));
    } else {
      shape.value(a) = share(first) * (2 * share(first) - 1);
      shape.derivative.row(a) = (4 * share(first) - 1) * slope.row(first);
    }
  }
  return shape;
}

}  // namespace

const std::vector<Position>& square_nodes() {
  static const std::vector<Position> nodes =
      with_middles({at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}});
  return nodes;
}

const std::vector<Position>& cube_nodes() {
  static const std::vector<Position> nodes =
      with_middles({at(-1, -1, -1), at(1, -1, -1), at(1, 1, -1), at(-1, 1, -1), at(-1, -1, 1),
                    at(1, -1, 1), at(1, 1, 1), at(-1, 1, 1)},
                   {{0, 1},
                    {1, 2},
                    {2, 3},
                    {3, 0},
                    {4, 5},
                    {5, 6},
                    {6, 7},
                    {7, 4},
                    {0, 4},
                    {1, 5},
                    {2, 6},
                    {3, 7}});
  return nodes;
}

const std::vector<Position>& triangle_nodes() {
  static const std::vector<Position> nodes =
      with_middles({at(0, 0), at(1, 0), at(0, 1)}, {{0, 1}, {1, 2}, {2, 0}});
  return nodes;
}

const std::vector<Position>& tetrahedron_nodes() {
  static const std::vector<Position> nodes =
      with_middles({at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0, 0, 1)},
                   {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}});
  return nodes;
}

Shape bilinear(const Position& xi) {
  Shape shape{NodeValues(4), NodeRows(4, 2)};
  for (int a = 0; a < 4; ++a) {
    const Position& node = square_nodes()[static_cast<std::size_t>(a)];
    const double u = 1 + node.x() * xi.x();
    const double v = 1 + node.y() * xi.y();
    shape.value(a) = 0.25 * u * v;
    shape.derivative.row(a) << 0.25 * node.x() * v, 0.25 * node.y() * u;
  }
  return shape;
}

Shape serendipity(const Position& xi) {
  Shape shape{NodeValues(8), NodeRows(8, 2)};
  const double x = xi.x();
  const double y = xi.y();
  for (int a = 0; a < 8; ++a) {
    const double s = square_nodes()[static_cast<std::size_t>(a)].x();
    const double t = square_nodes()[static_cast<std::size_t>(a)].y();
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

Shape trilinear(const Position& xi) {
  Shape shape{NodeValues(8), NodeRows(8, 3)};
  for (Eigen::Index a = 0; a < 8; ++a) {
    const Position& node = cube_nodes()[static_cast<std::size_t>(a)];
    shape.value(a) = product(node, xi, -1) / 8;
    for (Eigen::Index k = 0; k < 3; ++k)
      shape.derivative(a, k) = node(k) * product(node, xi, k) / 8;
  }
  return shape;
}

Shape serendipity_solid(const Position& xi) {
  Shape shape{NodeValues(20), NodeRows(20, 3)};
  for (Eigen::Index a = 0; a < 20; ++a) {
    const Position& node = cube_nodes()[static_cast<std::size_t>(a)];
    Eigen::Index along = 0;  // axis of the edge
    if (node.cwiseAbs().minCoeff(&along) > 0) {
      const double rest = node.dot(xi) - 2;
      shape.value(a) = product(node, xi, -1) * rest / 8;
      for (Eigen::Index k = 0; k < 3; ++k)
        shape.derivative(a, k) = node(k) * product(node, xi, k) * (rest + 1 + node(k) * xi(k)) / 8;
      continue;
    }
    const double bubble = 1 - xi(along) * xi(along);
    shape.value(a) = bubble * product(node, xi, along) / 4;
    for (Eigen::Index k = 0; k < 3; ++k)
      shape.derivative(a, k) = k == along ? -xi(along) * product(node, xi, along) / 2
                                          : bubble * node(k) * product(node, xi, along, k) / 4;
  }
  return shape;
}

Shape linear_triangle(const Position& xi) {
  Shape shape{NodeValues(3), NodeRows(3, 2)};
  shape.value << 1 - xi.x() - xi.y(), xi.x(), xi.y();
  shape.derivative << -1, -1, 1, 0, 0, 1;
  return shape;
}

Shape quadratic_triangle(const Position& xi) { return quadratic_simplex(xi, triangle_nodes()); }

Shape quadratic_tetrahedron(const Position& xi) {
  return quadratic_simplex(xi, tetrahedron_nodes());
}

namespace {

struct Gauss {
  std::vector<double> abscissae, weights;
};

Gauss gauss(int points) {
  if (points == 1) return {{0}, {2}};
  if (points == 2) return {{-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}, {1, 1}};
  return {{-std::sqrt(0.6), 0, std::sqrt(0.6)}, {5.0 / 9, 8.0 / 9, 5.0 / 9}};
}

}  // namespace

std::vector<LocalPoint> square_points(int per_direction) {
  std::vector<LocalPoint> points;
  if (per_direction == 2) {
    for (std::size_t a = 0; a < 4; ++a) points.push_back({square_nodes()[a] / std::sqrt(3.0), 1});
    return points;
  }
  const auto [x, w] = gauss(per_direction);
  for (std::size_t j = 0; j < x.size(); ++j)
    for (std::size_t i = 0; i < x.size(); ++i) points.push_back({at(x[i], x[j]), w[i] * w[j]});
  return points;
}

std::vector<LocalPoint> cube_points(int per_direction) {
  const auto [x, w] = gauss(per_direction);
  std::vector<LocalPoint> points;
  for (std::size_t k = 0; k < x.size(); ++k)
    for (std::size_t j = 0; j < x.size(); ++j)
      for (std::size_t i = 0; i < x.size(); ++i)
        points.push_back({at(x[i], x[j], x[k]), w[i] * w[j] * w[k]});
  return points;
}

std::vector<LocalPoint> simplex_points(int dimension) {
  // Every point has the share `far` of three or four corners but one, which has the rest.
  const double far = dimension == 2 ? 1.0 / 6 : (5 - std::sqrt(5.0)) / 20;
  const double weight = 1.0 / (dimension == 2 ? 6 : 24);
  std::vector<LocalPoint> points;
  for (int near = 0; near <= dimension; ++near) {
    Position xi = Position::Constant(dimension, far);
    if (near > 0) xi(near - 1) = 1 - dimension * far;
    points.push_back({xi, weight});
  }
  return points;
}

}  // namespace verification
