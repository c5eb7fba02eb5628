// Pressure and tractions: resultants, and their stiffness against differences.
#include "fe/conditions/side_loads.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace verification {
namespace {

class side_loads : public testing::TestWithParam<ElementKind> {
 protected:
  Mesh mesh = rectangle_mesh({2, 3}, {2, 3}, GetParam());
  Eigen::Index dofs = static_cast<Eigen::Index>(2 * mesh.nodes.size());

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
  static Eigen::Vector2d sum(const Eigen::VectorXd& force) {
    Eigen::Vector2d total = Eigen::Vector2d::Zero();
    for (int node = 0; 2 * node < force.size(); ++node) total += force.segment<2>(2 * node);
    return total;
  }
};

TEST_P(side_loads, a_traction_has_its_resultant_whatever_the_displacement) {
  const Loads loads{{}, {{mesh.side_sets["right"], 1, Program::linear(0, 10)}}};
  const Eigen::VectorXd found = force(loads, random_displacement());
  EXPECT_LT((sum(found) - Eigen::Vector2d(0, 5 * 3)).norm(), 1e-12);
  EXPECT_EQ(found, force(loads, Eigen::VectorXd::Zero(dofs)));
}

TEST_P(side_loads, a_dead_pressure_keeps_the_force_on_the_undeformed_side) {
  const Loads loads{{{mesh.side_sets["right"], Program::linear(0, 10), false}}, {}};
  EXPECT_LT((sum(force(loads, random_displacement())) - Eigen::Vector2d(-5 * 3, 0)).norm(), 1e-12);
}

TEST_P(side_loads, a_pressure_all_around_has_no_resultant_and_turns_with_the_body) {
  Loads loads;
  for (const auto& [name, sides] : mesh.side_sets)
    loads.pressures.push_back({sides, Program::linear(2, 2), true});
  EXPECT_LT(sum(force(loads, random_displacement())).norm(), 1e-13);
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  Eigen::VectorXd turned(dofs);
  for (int node = 0; 2 * node < dofs; ++node) {
    const Eigen::Vector2d& place = mesh.nodes[static_cast<std::size_t>(node)];
    turned.segment<2>(2 * node) = rotation * place - place;
  }
  const Eigen::VectorXd start = force(loads, Eigen::VectorXd::Zero(dofs));
  const Eigen::VectorXd found = force(loads, turned);
  for (int node = 0; 2 * node < dofs; ++node)
    EXPECT_LT((found.segment<2>(2 * node) - rotation * start.segment<2>(2 * node)).norm(), 1e-13);
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
  constexpr double h = 1e-3;  // the force is linear in the displacement
  for (Eigen::Index d = 0; d < dofs; ++d) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(dofs, d);
    const Eigen::VectorXd slope =
        (force(loads, displacement + step) - force(loads, displacement - step)) / (2 * h);
    EXPECT_LT((dense.col(d) + slope).norm(), 1e-10) << d;
  }
  EXPECT_GT(dense.norm(), 1);
}

INSTANTIATE_TEST_SUITE_P(kinds, side_loads,
                         testing::Values(ElementKind::q4, ElementKind::q8, ElementKind::t3),
                         [](const auto& entry) {
                           return std::string(element_type(entry.param).name);
                         });

}  // namespace
}  // namespace verification
