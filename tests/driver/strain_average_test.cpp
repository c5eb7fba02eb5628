// What resists a strain that differs from its average over a length.
#include "fe/scene.hpp"
#include "fe/solver/newton.hpp"
#include "scene_text.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace verification {
namespace {

constexpr double modulus = 1e6;  // Pa

Eigen::VectorXd displacement(const Mesh& mesh, auto&& field) {
  Eigen::VectorXd u(static_cast<Eigen::Index>(2 * mesh.nodes.size()));
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    u.segment<2>(static_cast<Eigen::Index>(2 * a)) = field(mesh.nodes[a]);
  return u;
}

Eigen::VectorXd force(const Mesh& mesh, double length, const Eigen::VectorXd& u) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
  StrainAverage(mesh, length, modulus).add_force(u, f);
  return f;
}

class strain_average : public testing::TestWithParam<ElementKind> {};

TEST_P(strain_average, leaves_a_strain_that_is_the_same_everywhere) {
  const Mesh mesh = box_mesh({0.3, 0.2}, {3, 2}, GetParam());
  const Tensor gradient = (Tensor() << 0.2, -0.7, 0.4, -0.1).finished();
  const Eigen::VectorXd u =
      displacement(mesh, [&](const Eigen::Vector2d& X) { return gradient * X; });
  EXPECT_LT(force(mesh, 0.05, u).norm(), 1e-12 * modulus * u.norm());
}

// u = sin(k X) in a strip of a whole wave; twice its energy is H l^2 k^2 / (1 + l^2 k^2) int u'^2.
TEST_P(strain_average, resists_a_wave_by_its_length) {
  const double k = 2 * std::numbers::pi;
  const Mesh mesh = box_mesh({1, 0.02}, {100, 1}, GetParam());
  const Eigen::VectorXd u = displacement(
      mesh, [&](const Eigen::Vector2d& X) { return Eigen::Vector2d(std::sin(k * X.x()) / k, 0); });
  for (const double length : {0.03, 0.3}) {
    const double square = length * length * k * k;
    const double expected = modulus * square / (1 + square) * 0.5 * 0.02;
    EXPECT_NEAR(u.dot(force(mesh, length, u)), expected, 0.01 * expected) << length;
  }
}

TEST_P(strain_average, stiffness_is_the_derivative_of_the_force) {
  const Mesh mesh = box_mesh({0.3, 0.2}, {3, 2}, GetParam());
  const StrainAverage average(mesh, 0.05, modulus);
  Triplets triplets;
  average.add_stiffness(triplets);
  const auto n = static_cast<Eigen::Index>(2 * mesh.nodes.size());
  Eigen::SparseMatrix<double> stiffness(n, n);
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::VectorXd u = displacement(mesh, [](const Eigen::Vector2d& X) {
    return Eigen::Vector2d(X.x() * X.y(), X.x() * X.x() - X.y());
  });
  const Eigen::VectorXd f = force(mesh, 0.05, u);
  EXPECT_GT(u.dot(f), 0);
  EXPECT_LT((stiffness * u - f).norm(), 1e-12 * f.norm());
}

INSTANTIATE_TEST_SUITE_P(elements, strain_average,
                         testing::Values(ElementKind::q4, ElementKind::q4fbar, ElementKind::q8,
                                         ElementKind::t3),
                         kind_name);

// A specimen that bulges between rough platens bulges less, and Newton is as quick.
TEST(strain_average_newton, stiffens_a_specimen_and_is_quadratic) {
  double force = 0;
  for (const double length : {0.0, 0.02}) {
    Model model;
    model.mesh = box_mesh({0.05, 0.05}, {2, 2}, ElementKind::q4fbar);
    model.average = {.length = length, .modulus = 0.2};
    const auto& sets = model.mesh.node_sets;
    for (const char* side : {"bottom", "top"})
      model.displacements.push_back({sets.at(side), 0, Program::linear(0, 0), side});
    model.displacements.push_back({sets.at("bottom"), 1, Program::linear(0, 0), "bottom_y"});
    model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -1e-4), "top_y"});
    for (const char* side : {"left", "right"})
      model.loads.pressures.push_back({model.mesh.side_sets[side], Program{{{0, 1e5}}, {}}, true});
    const Material material = lattice_material();
    const auto solver = make_newton_solver(model, material, {.tolerance = 1e-10}, 1);
    solver->advance(0, 0);
    const LoadStep step = solver->advance(1, 1);
    EXPECT_LE(step.residuals.size(), 5U);
    const double found = std::abs(step.reactions.back());
    EXPECT_GT(found, (1 + 1e-4) * force);
    force = found;
  }
}

}  // namespace
}  // namespace verification
