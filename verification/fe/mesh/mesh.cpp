#include "fe/mesh/mesh.hpp"

namespace verification {

std::vector<Eigen::Vector2d> Mesh::positions(const std::vector<int>& element) const {
  std::vector<Eigen::Vector2d> result;
  for (const int node : element) result.push_back(nodes[static_cast<std::size_t>(node)]);
  return result;
}

Mesh rectangle_mesh(const std::array<double, 2>& size, const std::array<int, 2>& divisions,
                    ElementKind kind) {
  const bool quadratic = kind == ElementKind::q8;
  const int stride = quadratic ? 2 : 1;  // node lines per cell
  const int columns = stride * divisions[0];
  const int rows = stride * divisions[1];
  Mesh mesh;
  mesh.kind = kind;
  // Node number at line i, j; the middle of a serendipity cell has none.
  std::vector<int> number(static_cast<std::size_t>((columns + 1) * (rows + 1)), -1);
  const auto node = [&](int i, int j) -> int& {
    return number[static_cast<std::size_t>(j * (columns + 1) + i)];
  };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      if (quadratic && i % 2 == 1 && j % 2 == 1) continue;
      node(i, j) = static_cast<int>(mesh.nodes.size());
      mesh.nodes.emplace_back(size[0] * i / columns, size[1] * j / rows);
    }
  for (int j = 0; j < rows; j += stride)
    for (int i = 0; i < columns; i += stride) {
      const int a = node(i, j), b = node(i + stride, j);
      const int c = node(i + stride, j + stride), d = node(i, j + stride);
      if (kind == ElementKind::t3) {
        mesh.elements.push_back({a, b, c});
        mesh.elements.push_back({a, c, d});
      } else if (quadratic) {
        mesh.elements.push_back(
            {a, b, c, d, node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2), node(i, j + 1)});
      } else {
        mesh.elements.push_back({a, b, c, d});
      }
    }
  const auto side = [&](int first, int middle, int second) {
    return quadratic ? Side{first, second, middle} : Side{first, second};
  };
  for (int i = 0; i <= columns; ++i) {
    mesh.node_sets["bottom"].push_back(node(i, 0));
    mesh.node_sets["top"].push_back(node(i, rows));
    if (i % stride != 0 || i == columns) continue;
    const int end = i + stride;
    mesh.side_sets["bottom"].push_back(side(node(i, 0), node(i + 1, 0), node(end, 0)));
    mesh.side_sets["top"].push_back(side(node(end, rows), node(i + 1, rows), node(i, rows)));
  }
  for (int j = 0; j <= rows; ++j) {
    mesh.node_sets["left"].push_back(node(0, j));
    mesh.node_sets["right"].push_back(node(columns, j));
    if (j % stride != 0 || j == rows) continue;
    const int end = j + stride;
    mesh.side_sets["left"].push_back(side(node(0, end), node(0, j + 1), node(0, j)));
    mesh.side_sets["right"].push_back(
        side(node(columns, j), node(columns, j + 1), node(columns, end)));
  }
  mesh.node_sets["bottom_left"] = {node(0, 0)};
  mesh.node_sets["bottom_right"] = {node(columns, 0)};
  mesh.node_sets["top_right"] = {node(columns, rows)};
  mesh.node_sets["top_left"] = {node(0, rows)};
  return mesh;
}

}  // namespace verification
