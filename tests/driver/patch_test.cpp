// Patch test: a solved mesh whose boundary moves affinely deforms affinely inside, and the stiffness
// of the points is the derivative of their forces.
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace verification {
namespace {

class patch : public testing::TestWithParam<ElementKind> {
 protected:
  static Mesh distorted_mesh() {
    Mesh mesh = rectangle_mesh({1, 1}, {2, 2}, GetParam());
    for (auto& node : mesh.nodes) {  // quadratic, so that straight sides become curved
      const double bubble = 16 * node.x() * (1 - node.x()) * node.y() * (1 - node.y());
      node += Eigen::Vector2d(0.07 * bubble, -0.05 * bubble);
    }
    return mesh;
  }
  static Model affine_model(const Tensor& gradient) {
    Model model;
    model.mesh = distorted_mesh();
    std::set<int> boundary;
    for (const char* side : {"left", "right", "bottom", "top"})
      boundary.insert(model.mesh.node_sets[side].begin(), model.mesh.node_sets[side].end());
    for (const int node : boundary)
      for (const int i : {0, 1}) {
        const double value = gradient.row(i) * model.mesh.nodes[static_cast<std::size_t>(node)];
        model.displacements.push_back({{node}, i, Program::linear(0, value), ""});
      }
    return model;
  }
};

TEST_P(patch, the_inside_follows_an_affine_boundary) {
  Tensor gradient;
  gradient << 2e-3, 1e-3, -5e-4, -3e-3;
  const Model model = affine_model(gradient);
  const Material material = lattice_material();
  const auto solver = make_newton_solver(model, material, {.tolerance = 1e-11}, 1);
  run_load_steps(*solver, 1, 1, 1, [](const LoadStep&, const Solver&) {});
  for (std::size_t node = 0; node < model.mesh.nodes.size(); ++node) {
    const auto row = static_cast<Eigen::Index>(2 * node);
    EXPECT_LT((solver->displacement().segment<2>(row) - gradient * model.mesh.nodes[node]).norm(),
              1e-12);
  }
}

TEST_P(patch, the_stiffness_is_the_derivative_of_the_forces) {
  Model model;
  model.mesh = distorted_mesh();
  const Mesh& mesh = model.mesh;
  const Material material = lattice_material();
  PointField points(model, material);
  const auto dofs = static_cast<Eigen::Index>(2 * mesh.nodes.size());
  Eigen::VectorXd place(dofs);  // neither symmetric nor affine
  for (Eigen::Index d = 0; d < dofs; ++d) place(d) = 1e-4 * std::sin(3.0 * static_cast<double>(d));
  ASSERT_EQ(points.evaluate(place, GRAINLAW_WANT_TANGENT_EXACT, 1), GRAINLAW_OK);
  Triplets triplets;
  points.add_stiffness(triplets);
  Eigen::SparseMatrix<double> stiffness(dofs, dofs);
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::VectorXd direction(dofs);
  for (Eigen::Index d = 0; d < dofs; ++d) direction(d) = std::cos(5.0 * static_cast<double>(d));
  constexpr double h = 1e-7;
  const auto force = [&](double step) {
    points.evaluate(place + step * direction, 0, 1);
    return points.internal_force();
  };
  const Eigen::VectorXd slope = (force(h) - force(-h)) / (2 * h);
  const Eigen::VectorXd product = stiffness * direction;
  EXPECT_LT((product - slope).norm(), 1e-6 * slope.norm());
}

INSTANTIATE_TEST_SUITE_P(kinds, patch, element_kinds, kind_name);

}  // namespace
}  // namespace verification
