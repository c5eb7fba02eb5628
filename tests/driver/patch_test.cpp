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
  const int dimension = element_type(GetParam()).dimension;
  const Material material = lattice_of(dimension);
  // Neither symmetric nor a rotation.
  const Eigen::MatrixXd gradient =
      1e-3 * (Eigen::Matrix3d() << 2, 1, -0.7, -0.5, -3, 0.4, 0.3, 0.8, 1.5)
                 .finished()
                 .topLeftCorner(dimension, dimension);

  [[nodiscard]] Mesh distorted_mesh() const {
    Mesh mesh = box_mesh(std::vector<double>(static_cast<std::size_t>(dimension), 1.0),
                         std::vector<int>(static_cast<std::size_t>(dimension), 2), GetParam());
    const Position direction = Eigen::Vector3d(0.07, -0.05, 0.06).head(dimension);
    for (Position& node : mesh.nodes) {  // quadratic, so that straight sides become curved
      double bubble = 1;
      for (const double x : node) bubble *= 4 * x * (1 - x);
      node += bubble * direction;
    }
    // Four points are exact in straight tetrahedra alone.
    if (GetParam() == ElementKind::tet10) straighten(mesh);
    return mesh;
  }
  [[nodiscard]] Model affine_model() const {
    Model model;
    model.mesh = distorted_mesh();
    std::set<int> boundary;
    for (const auto& [name, nodes] : model.mesh.node_sets)
      boundary.insert(nodes.begin(), nodes.end());
    for (const int node : boundary)
      for (int i = 0; i < dimension; ++i) {
        const double value = gradient.row(i) * model.mesh.position(node);
        model.displacements.push_back({{node}, i, Program::linear(0, value), ""});
      }
    return model;
  }
};

TEST_P(patch, the_inside_follows_an_affine_boundary_with_the_stress_of_one_volume) {
  const Model model = affine_model();
  const auto solver = make_newton_solver(model, material, {.tolerance = 1e-11}, 1);
  LoadStep step;
  run_load_steps(*solver, 1, 1, 1, [&](const LoadStep& made, const Solver&) { step = made; });
  for (int node = 0; node < static_cast<int>(model.mesh.nodes.size()); ++node)
    EXPECT_LT(
        (model.mesh.moved(node, solver->displacement()) - gradient * model.mesh.position(node))
            .norm(),
        1e-12);
  in_dimension(dimension, [&]<int D>() {
    State state(material);
    const TensorOf<D> deformation = TensorOf<D>::Identity() + gradient;
    const EvaluationOf<D> one = evaluate_of<D>(state, deformation, 0);
    EXPECT_LT((step.record.stress - one.stress).norm(), 1e-10 * one.stress.norm());
  });
}

TEST_P(patch, the_stiffness_is_the_derivative_of_the_forces) {
  Model model;
  model.mesh = distorted_mesh();
  PointField points(model, material);
  const Eigen::Index dofs = model.mesh.dofs();
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

INSTANTIATE_TEST_SUITE_P(kinds, patch, all_element_kinds, kind_name);

}  // namespace
}  // namespace verification
