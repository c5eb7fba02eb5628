// Elements: shape functions, quadrature, affine fields, on regular and on distorted meshes.
#include "fe/mesh/element.hpp"
#include "fe/mesh/mesh.hpp"

#include "support.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace verification {
namespace {

using Points = std::vector<Eigen::Vector2d>;

class element : public testing::TestWithParam<ElementKind> {
 protected:
  // Corners moved by up to a fifth of a cell, mid-side nodes left in the middle of their sides.
  static Mesh distorted_mesh() {
    Mesh mesh = rectangle_mesh({2, 3}, {2, 3}, GetParam());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.2, 0.2);
    const auto corners = static_cast<std::size_t>(element_type(GetParam()).corners);
    for (auto& node : mesh.nodes) node += Eigen::Vector2d(shift(random), shift(random));
    for (const auto& nodes : mesh.elements)
      for (std::size_t side = 0; corners + side < nodes.size(); ++side) {
        const auto at = [&](std::size_t k) { return static_cast<std::size_t>(nodes[k]); };
        mesh.nodes[at(corners + side)] =
            0.5 * (mesh.nodes[at(side)] + mesh.nodes[at((side + 1) % corners)]);
      }
    return mesh;
  }
};

TEST_P(element, shape_functions_are_one_at_their_node_and_zero_at_the_others) {
  const ElementType& type = element_type(GetParam());
  for (int a = 0; a < type.nodes; ++a) {
    const Shape shape = type.shape(type.local_nodes[static_cast<std::size_t>(a)]);
    for (int b = 0; b < type.nodes; ++b) EXPECT_NEAR(shape.value(b), a == b ? 1 : 0, 1e-15);
  }
}

TEST_P(element, derivatives_are_those_of_the_shape_functions) {
  const ElementType& type = element_type(GetParam());
  const Eigen::Vector2d place(0.31, 0.17);
  constexpr double h = 1e-5;
  const Shape shape = type.shape(place);
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(k);
    const NodeValues slope =
        (type.shape(place + step).value - type.shape(place - step).value) / (2 * h);
    EXPECT_LT((slope - shape.derivative.col(k)).norm(), 1e-10);
  }
}

TEST_P(element, weights_add_up_to_the_area) {
  const Mesh mesh = distorted_mesh();
  const auto corners = static_cast<std::size_t>(element_type(GetParam()).corners);
  for (const auto& nodes : mesh.elements) {
    double area = 0;
    for (const QuadPoint& point : quad_points(mesh.kind, mesh.positions(nodes)))
      area += point.weight;
    Points polygon = mesh.positions(nodes);
    polygon.resize(corners);
    EXPECT_NEAR(area, polygon_area(polygon), 1e-13);
  }
}

TEST_P(element, an_affine_displacement_gives_its_gradient_at_every_point) {
  const Mesh mesh = distorted_mesh();
  Eigen::Matrix2d gradient;
  gradient << 0.1, -0.4, 0.7, -0.2;
  for (const auto& nodes : mesh.elements)
    for (const QuadPoint& point : quad_points(mesh.kind, mesh.positions(nodes))) {
      Eigen::Matrix2d found = Eigen::Matrix2d::Zero();
      for (std::size_t a = 0; a < nodes.size(); ++a)
        found += gradient * mesh.nodes[static_cast<std::size_t>(nodes[a])] *
                 point.gradient.row(static_cast<Eigen::Index>(a));
      EXPECT_LT((found - gradient).norm(), 1e-13);
    }
}

TEST_P(element, sides_run_with_their_element_on_the_left) {
  const Mesh mesh = rectangle_mesh({2, 3}, {2, 3}, GetParam());
  const Eigen::Vector2d centre(1, 1.5);
  double perimeter = 0;
  for (const auto& [name, sides] : mesh.side_sets)
    for (const Side& side : sides) {
      const Eigen::Vector2d first = mesh.nodes[static_cast<std::size_t>(side[0])];
      const Eigen::Vector2d along = mesh.nodes[static_cast<std::size_t>(side[1])] - first;
      const Eigen::Vector2d inward = centre - first;
      EXPECT_GT(along.x() * inward.y() - along.y() * inward.x(), 0) << name;
      perimeter += along.norm();
      if (side.size() == 3) {
        const Eigen::Vector2d middle = mesh.nodes[static_cast<std::size_t>(side[2])];
        EXPECT_LT((middle - first - 0.5 * along).norm(), 1e-14) << name;
      }
    }
  EXPECT_NEAR(perimeter, 10, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(kinds, element, element_kinds, kind_name);

}  // namespace
}  // namespace verification
