#include "fe/mesh/mesh.hpp"

#include <cmath>

namespace verification {

Mesh rectangle_mesh(const std::array<double, 2>& size, const std::array<int, 2>& divisions,
                    ElementKind kind) {
  const auto [columns, rows] = divisions;
  Mesh mesh;
  const auto node = [&](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.nodes.emplace_back(size[0] * i / columns, size[1] * j / rows);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
      if (kind == ElementKind::q4) {
        mesh.elements.push_back({a, b, c, d});
      } else {
        mesh.elements.push_back({a, b, c});
        mesh.elements.push_back({a, c, d});
      }
    }
  for (int i = 0; i <= columns; ++i) {
    mesh.node_sets["bottom"].push_back(node(i, 0));
    mesh.node_sets["top"].push_back(node(i, rows));
    if (i == columns) continue;
    mesh.side_sets["bottom"].push_back({node(i, 0), node(i + 1, 0)});
    mesh.side_sets["top"].push_back({node(i + 1, rows), node(i, rows)});
  }
  for (int j = 0; j <= rows; ++j) {
    mesh.node_sets["left"].push_back(node(0, j));
    mesh.node_sets["right"].push_back(node(columns, j));
    if (j == rows) continue;
    mesh.side_sets["left"].push_back({node(0, j + 1), node(0, j)});
    mesh.side_sets["right"].push_back({node(columns, j), node(columns, j + 1)});
  }
  return mesh;
}

namespace {

QuadPoint triangle_point(const std::vector<Eigen::Vector2d>& corners) {
  Eigen::Matrix2d edges;
  edges << corners[1] - corners[0], corners[2] - corners[0];
  QuadPoint point;
  point.gradient.resize(3, 2);
  point.gradient.bottomRows<2>() = edges.inverse();
  point.gradient.row(0) = -point.gradient.row(1) - point.gradient.row(2);
  point.weight = 0.5 * edges.determinant();
  return point;
}

}  // namespace

std::vector<QuadPoint> quad_points(const std::vector<Eigen::Vector2d>& corners) {
  if (corners.size() == 3) return {triangle_point(corners)};
  constexpr std::array<std::array<double, 2>, 4> sign{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  std::vector<QuadPoint> points(4);
  for (std::size_t q = 0; q < 4; ++q) {
    const double xi = sign[q][0] / std::sqrt(3.0);
    const double eta = sign[q][1] / std::sqrt(3.0);
    Eigen::Matrix<double, 4, 2> local;                   // dN_a/dxi
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();  // dX/dxi
    for (std::size_t a = 0; a < 4; ++a) {
      const auto row = static_cast<Eigen::Index>(a);
      local.row(row) << 0.25 * sign[a][0] * (1 + sign[a][1] * eta),
          0.25 * sign[a][1] * (1 + sign[a][0] * xi);
      jacobian += corners[a] * local.row(row);
    }
    points[q] = {local * jacobian.inverse(), jacobian.determinant()};
  }
  return points;
}

}  // namespace verification
