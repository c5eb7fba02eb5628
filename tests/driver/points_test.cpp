// The integration points of a mesh.
#include "fe/model.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace verification {
namespace {

TEST(points, a_refusal_names_the_point) {
  Model model;
  model.hourglass = 0;
  model.mesh = box_mesh({0.1, 0.05}, {2, 1}, ElementKind::q4r);
  const Mesh& mesh = model.mesh;
  const Material material = lattice_material();
  PointField points(model, material);
  Eigen::VectorXd displacement =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * mesh.nodes.size()));
  for (const int node : mesh.node_sets.at("right")) displacement[2 * node] = 0.025;
  EXPECT_EQ(points.evaluate(displacement, 0, 1), GRAINLAW_STEP_TOO_LARGE);
  EXPECT_EQ(points.message(),
            "integration point 1: the stretch since the committed state is more than 30 %");
  EXPECT_LT(points.step_ratio(), 1);
}

// The mean of F is then that of the boundary.
TEST(points, count_by_their_size_in_means) {
  Model model;
  model.hourglass = 0;
  model.mesh = box_mesh({0.1, 0.05}, {2, 1}, ElementKind::q4r);
  Mesh& mesh = model.mesh;
  for (auto& node : mesh.nodes)
    if (std::abs(node[0] - 0.05) < 1e-9) node[0] = 0.025;
  const Material material = lattice_material();
  PointField points(model, material);
  Eigen::VectorXd displacement =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * mesh.nodes.size()));
  for (const int node : mesh.node_sets.at("right")) displacement[2 * node] = -1e-6;
  ASSERT_EQ(points.evaluate(displacement, 0, 1), GRAINLAW_OK);
  EXPECT_NEAR(points.record().deformation(0, 0), 1 - 1e-6 / 0.1, 1e-15);
}

}  // namespace
}  // namespace verification
