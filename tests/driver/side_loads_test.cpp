// Pressure and tractions: resultants, and their stiffness against differences.
#include "fe/conditions/side_loads.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace verification {
namespace {

class side_loads : public testing::TestWithParam<ElementKind> {
 protected:
  const int dimension = element_type(GetParam()).dimension;
  // 2 x 3 m, or 2 x 3 x 1.
  Mesh mesh = dimension == 2 ? box_mesh({2, 3}, {2, 3}, GetParam())
                             : box_mesh({2, 3, 1}, {2, 1, 1}, GetParam());
  Eigen::Index dofs = mesh.dofs();

  [[nodiscard]] Eigen::VectorXd random_displacement() const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> value(-0.1, 0.1);
    return Eigen::VectorXd::NullaryExpr(dofs, [&] { return value(random); });
  }
  Eigen::VectorXd force(const Loads& loads, const Eigen::VectorXd& displacement) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(dofs);
    add_loads(loads, 0.5, mesh, displacement, result, nullptr);
    return result;
  }
  [[nodiscard]] Position sum(const Eigen::VectorXd& force) const {
    Position total = Position::Zero(dimension);
    for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node)
      total += mesh.moved(node, force);
    return total;
  }
  [[nodiscard]] Position vector(double x, double y) const {
    return Eigen::Vector3d(x, y, 0).head(dimension);
  }
};

TEST_P(side_loads, a_traction_has_its_resultant_whatever_the_displacement) {
  const Loads loads{{}, {{mesh.side_sets["right"], 1, Program::linear(0, 10)}}};
  const Eigen::VectorXd found = force(loads, random_displacement());
  EXPECT_LT((sum(found) - vector(0, 5 * 3)).norm(), 1e-12);
  EXPECT_EQ(found, force(loads, Eigen::VectorXd::Zero(dofs)));
}

TEST_P(side_loads, a_dead_pressure_keeps_the_force_on_the_undeformed_side) {
  const Loads loads{{{mesh.side_sets["right"], Program::linear(0, 10), false}}, {}};
  EXPECT_LT((sum(force(loads, random_displacement())) - vector(-5 * 3, 0)).norm(), 1e-12);
}

TEST_P(side_loads, a_pressure_pushes_every_side_inwards_with_its_size) {
  const auto ends =
      dimension == 2
          ? std::vector<std::pair<const char*, int>>{{"left", 0}, {"bottom", 1}}
          : std::vector<std::pair<const char*, int>>{{"left", 0}, {"front", 1}, {"bottom", 2}};
  const Position size = mesh.high() - mesh.low();
  for (const auto& [name, axis] : ends) {
    const Loads loads{{{mesh.side_sets.at(name), Program::linear(4, 4), true}}, {}};
    const Position expected = 4 * size.prod() / size(axis) * Position::Unit(dimension, axis);
    EXPECT_LT((sum(force(loads, Eigen::VectorXd::Zero(dofs))) - expected).norm(), 1e-12) << name;
  }
}

TEST_P(side_loads, a_pressure_all_around_has_no_resultant_and_turns_with_the_body) {
  Loads loads;
  for (const auto& [name, sides] : mesh.side_sets)
    loads.pressures.push_back({sides, Program::linear(2, 2), true});
  EXPECT_LT(sum(force(loads, random_displacement())).norm(), 1e-13);
  const Eigen::MatrixXd rotation =
      dimension == 2
          ? Eigen::MatrixXd(Eigen::Rotation2Dd(0.7).toRotationMatrix())
          : Eigen::MatrixXd(
                Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix());
  Eigen::VectorXd turned(dofs);
  const auto nodes = static_cast<int>(mesh.nodes.size());
  for (int node = 0; node < nodes; ++node)
    turned.segment(mesh.dof(node, 0), dimension) =
        rotation * mesh.position(node) - mesh.position(node);
  const Eigen::VectorXd start = force(loads, Eigen::VectorXd::Zero(dofs));
  const Eigen::VectorXd found = force(loads, turned);
  for (int node = 0; node < nodes; ++node)
    EXPECT_LT((mesh.moved(node, found) - rotation * mesh.moved(node, start)).norm(), 1e-13);
}

TEST_P(side_loads, the_load_stiffness_is_minus_the_derivative_of_the_force) {
  const Loads loads{{{mesh.side_sets["right"], Program::linear(0, 10), true},
                     {mesh.side_sets["top"], Program::linear(0, -4), true}},
                    {{mesh.side_sets["left"], 0, Program::linear(0, 3)}}};
  const Eigen::VectorXd displacement = random_displacement();
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(dofs);
  Triplets triplets;
  add_loads(loads, 0.5, mesh, displacement, unused, &triplets);
  Eigen::SparseMatrix<double> stiffness(dofs, dofs);
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::MatrixXd dense(stiffness);
  constexpr double h = 1e-3;  // the force is linear or quadratic in the displacement
  for (Eigen::Index d = 0; d < dofs; ++d) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(dofs, d);
    const Eigen::VectorXd slope =
        (force(loads, displacement + step) - force(loads, displacement - step)) / (2 * h);
    EXPECT_LT((dense.col(d) + slope).norm(), 1e-10) << d;
  }
  EXPECT_GT(dense.norm(), 1);
}

INSTANTIATE_TEST_SUITE_P(kinds, side_loads,
                         testing::Values(ElementKind::q4, ElementKind::q8, ElementKind::t3,
                                         ElementKind::hex8, ElementKind::hex20, ElementKind::tet10),
                         [](const auto& entry) {
                           return std::string(element_type(entry.param).name);
                         });

}  // namespace
}  // namespace verification
