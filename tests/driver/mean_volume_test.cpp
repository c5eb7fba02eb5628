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
  const int dimension = element_type(kind).dimension, last = dimension - 1;
  const auto axes = static_cast<std::size_t>(dimension);
  model.mesh = box_mesh(std::vector<double>(axes, 0.05), std::vector<int>(axes, 2), kind);
  const auto& sets = model.mesh.node_sets;
  for (const char* side : {"bottom", "top"})
    for (int i = 0; i < last; ++i)
      model.displacements.push_back({sets.at(side), i, Program::linear(0, 0), side});
  model.displacements.push_back({sets.at("bottom"), last, Program::linear(0, 0), "bottom"});
  model.displacements.push_back({sets.at("top"), last, Program::linear(0, -0.05 * strain), "top"});
  const double pressure = dimension == 2 ? 1e5 : 7e5;  // [Pa], near the stress of the packing
  for (const char* side : {"left", "right", "front", "back"})
    if (sets.contains(side))
      model.loads.pressures.push_back(
          {model.mesh.side_sets[side], Program{{{0, pressure}}, {}}, true});
  return model;
}

struct Solved {
  LoadStep step;
  double apart = 0;  // largest difference of the volume ratios of an element's points [-]
};

Solved compress(ElementKind kind, double strain) {
  const Model model = rough_specimen(kind, strain);
  const Material material = lattice_of(model.mesh.dimension());
  const auto solver = make_newton_solver(model, material, {.tolerance = 1e-10}, 1);
  solver->advance(0, 0);
  Solved solved{solver->advance(1, 1), 0};
  const PointField& points = solver->points();
  const std::size_t of_element = element_type(kind).points.size();
  for (std::size_t p = 0; p < points.size(); p += of_element)
    for (std::size_t other = p + 1; other < p + of_element; ++other)
      solved.apart = std::max(solved.apart, std::abs(points.deformation(other).determinant() -
                                                     points.deformation(p).determinant()));
  return solved;
}

TEST(mean_volume, points_of_an_element_share_one_area_ratio) {
  EXPECT_GT(compress(ElementKind::q4, 2e-3).apart, 1e-5);
  EXPECT_LT(compress(ElementKind::q4fbar, 2e-3).apart, 1e-14);
}

TEST(mean_volume, points_of_a_solid_element_share_one_volume_ratio) {
  EXPECT_GT(compress(ElementKind::hex8, 1e-3).apart, 1e-5);
  EXPECT_LT(compress(ElementKind::hex8fbar, 1e-3).apart, 1e-14);
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
