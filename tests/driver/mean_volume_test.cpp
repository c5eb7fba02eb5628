// Quadrilaterals whose points share one area ratio; that they pass the patch test and have an exact
// stiffness is shown with the other elements.
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

// Between rough platens, which bulge the sides, compressed in one load step.
Model rough_specimen(ElementKind kind, double strain) {
  Model model;
  model.mesh = rectangle_mesh({0.05, 0.05}, {2, 2}, kind);
  const auto& sets = model.mesh.node_sets;
  for (const char* side : {"bottom", "top"})
    model.displacements.push_back({sets.at(side), 0, Program::linear(0, 0), side});
  model.displacements.push_back({sets.at("bottom"), 1, Program::linear(0, 0), "bottom_y"});
  model.displacements.push_back({sets.at("top"), 1, Program::linear(0, -0.05 * strain), "top_y"});
  for (const char* side : {"left", "right"})
    model.loads.pressures.push_back({model.mesh.side_sets[side], Program{{{0, 1e5}}, {}}, true});
  return model;
}

struct Solved {
  LoadStep step;
  double apart = 0;  // largest difference of the area ratios of an element's points [-]
};

Solved compress(ElementKind kind, double strain, double tolerance = 1e-10) {
  const Model model = rough_specimen(kind, strain);
  const Material material = lattice_material();
  const auto solver = make_newton_solver(model, material, {.tolerance = tolerance}, 1);
  solver->advance(0, 0);
  Solved solved{solver->advance(1, 1), 0};
  const PointField& points = solver->points();
  for (std::size_t p = 0; p < points.size(); p += 4)
    for (std::size_t other = p + 1; other < p + 4; ++other)
      solved.apart = std::max(solved.apart, std::abs(points.deformation(other).determinant() -
                                                     points.deformation(p).determinant()));
  return solved;
}

TEST(mean_volume, points_of_an_element_share_one_area_ratio) {
  EXPECT_GT(compress(ElementKind::q4, 2e-3).apart, 1e-5);
  EXPECT_LT(compress(ElementKind::q4fbar, 2e-3).apart, 1e-14);
}

TEST(mean_volume, newton_is_quadratic) {
  const std::vector<double> residuals = compress(ElementKind::q4fbar, 2e-3).step.residuals;
  ASSERT_GE(residuals.size(), 3U);
  EXPECT_LE(residuals.size(), 5U);
  for (std::size_t k = 2; k < residuals.size(); ++k)
    EXPECT_LT(residuals[k], std::max(10 * residuals[k - 1] * residuals[k - 1], 1e-10)) << k;
}

// The record is of the mesh.
TEST(mean_volume, the_mean_deformation_is_that_of_the_body) {
  const LoadStep step = compress(ElementKind::q4fbar, 2e-3).step;
  EXPECT_NEAR(step.record.deformation(1, 1), 1 - 2e-3, 1e-14);
}

}  // namespace
}  // namespace verification
