// Elements: shape functions, quadrature, affine fields, on regular and on distorted meshes.
#include "fe/mesh/element.hpp"
#include "fe/mesh/mesh.hpp"

#include "support.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

namespace verification {
namespace {

class element : public testing::TestWithParam<ElementKind> {
 protected:
  static Mesh regular_mesh() {
    return element_type(GetParam()).dimension == 2 ? box_mesh({2, 3}, {2, 3}, GetParam())
                                                   : box_mesh({2, 3, 1}, {2, 2, 2}, GetParam());
  }
  // Inner corners moved by up to a fifth of a cell, nodes amid edges left in the middle.
  static Mesh distorted_mesh() {
    Mesh mesh = regular_mesh();
    std::set<int> outer;
    for (const auto& [name, nodes] : mesh.node_sets) outer.insert(nodes.begin(), nodes.end());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
      for (double& x : mesh.nodes[node])
        if (!outer.contains(static_cast<int>(node))) x += shift(random);
    straighten(mesh);
    return mesh;
  }
};

TEST(element_kinds, those_that_do_not_lock_are_the_default) {
  EXPECT_EQ(element_kinds_of(2).front(), ElementKind::q4fbar);
  EXPECT_EQ(element_kinds_of(3).front(), ElementKind::hex8fbar);
}

TEST_P(element, shape_functions_are_one_at_their_node_and_zero_at_the_others) {
  const ElementType& type = element_type(GetParam());
  for (int a = 0; a < type.nodes; ++a) {
    const Shape shape = type.shape(type.local_nodes[static_cast<std::size_t>(a)]);
    for (int b = 0; b < type.nodes; ++b) EXPECT_NEAR(shape.value(b), a == b ? 1 : 0, 1e-15);
  }
}

TEST_P(element, derivatives_are_those_of_the_shape_functions) {
  const ElementType& type = element_type(GetParam());
  const Position place = Eigen::Vector3d(0.31, 0.17, 0.23).head(type.dimension);
  constexpr double h = 1e-5;
  const Shape shape = type.shape(place);
  for (int k = 0; k < type.dimension; ++k) {
    const Position step = h * Position::Unit(type.dimension, k);
    const NodeValues slope =
        (type.shape(place + step).value - type.shape(place - step).value) / (2 * h);
    EXPECT_LT((slope - shape.derivative.col(k)).norm(), 1e-10);
  }
}

TEST_P(element, weights_add_up_to_the_area_or_volume) {
  const Mesh mesh = distorted_mesh();
  double sum = 0;
  for (const auto& nodes : mesh.elements)
    for (const QuadPoint& point : quad_points(mesh.kind, mesh.positions(nodes))) {
      EXPECT_GT(point.weight, 0);
      sum += point.weight;
    }
  EXPECT_NEAR(sum, 6, 1e-13);
}

TEST_P(element, an_affine_displacement_gives_its_gradient_at_every_point) {
  const Mesh mesh = distorted_mesh();
  const int d = mesh.dimension();
  const Eigen::MatrixXd gradient =
      (Eigen::Matrix3d() << 0.1, -0.4, 0.3, 0.7, -0.2, 0.5, -0.6, 0.2, 0.9)
          .finished()
          .topLeftCorner(d, d);
  for (const auto& nodes : mesh.elements)
    for (const QuadPoint& point : quad_points(mesh.kind, mesh.positions(nodes))) {
      Eigen::MatrixXd found = Eigen::MatrixXd::Zero(d, d);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        found +=
            gradient * mesh.position(nodes[a]) * point.gradient.row(static_cast<Eigen::Index>(a));
      EXPECT_LT((found - gradient).norm(), 1e-12);
    }
}

// A line has its element on the left, a face is anticlockwise from outside.
TEST_P(element, sides_enclose_the_body_and_have_their_middles) {
  const Mesh mesh = regular_mesh();
  const Position centre = 0.5 * (mesh.low() + mesh.high());
  const bool solid = mesh.dimension() == 3;
  double size = 0;
  for (const auto& [name, sides] : mesh.side_sets)
    for (const Side& side : sides) {
      const Position first = mesh.position(side[0]);
      const Position along = mesh.position(side[1]) - first, inward = centre - first;
      if (solid) {
        const bool triangle = side.size() % 3 == 0;
        const Eigen::Vector3d up = mesh.position(side[2]) - mesh.position(side[1]);
        const Eigen::Vector3d area = (triangle ? 0.5 : 1) * Eigen::Vector3d(along).cross(up);
        EXPECT_LT(area.dot(Eigen::Vector3d(inward)), 0) << name;
        size += area.norm();
      } else {
        EXPECT_GT(along.x() * inward.y() - along.y() * inward.x(), 0) << name;
        size += along.norm();
      }
      const std::size_t corners = solid ? (side.size() % 3 == 0 ? 3 : 4) : 2;
      for (std::size_t k = 0; corners + k < side.size(); ++k)
        EXPECT_LT((2 * mesh.position(side[corners + k]) - mesh.position(side[k]) -
                   mesh.position(side[(k + 1) % corners]))
                      .norm(),
                  1e-14)
            << name;
    }
  EXPECT_NEAR(size, solid ? 22 : 10, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(kinds, element, all_element_kinds, kind_name);

}  // namespace
}  // namespace verification
