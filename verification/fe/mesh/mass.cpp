#include "fe/mesh/mass.hpp"

#include <cmath>

namespace verification {
namespace {

// Shape functions of the four corners at the 2 x 2 Gauss points, in the order of quad_points.
Eigen::Matrix4d bilinear_shapes() {
  const Eigen::Array4d xi{-1, 1, 1, -1}, eta{-1, -1, 1, 1};
  Eigen::Matrix4d shapes;  // (point, node)
  for (int q = 0; q < 4; ++q)
    shapes.row(q) = 0.25 * (1 + xi * xi(q) / std::sqrt(3.0)) * (1 + eta * eta(q) / std::sqrt(3.0));
  return shapes;
}

Eigen::VectorXd element_mass(const std::vector<Eigen::Vector2d>& corners) {
  const auto points = quad_points(corners);
  if (corners.size() == 3) return Eigen::VectorXd::Constant(3, points[0].weight / 3);
  static const Eigen::Matrix4d shapes = bilinear_shapes();
  Eigen::VectorXd share = Eigen::VectorXd::Zero(4);
  double area = 0;
  for (int q = 0; q < 4; ++q) {
    const double weight = points[static_cast<std::size_t>(q)].weight;
    share += weight * shapes.row(q).transpose().cwiseAbs2();
    area += weight;
  }
  return area / share.sum() * share;
}

}  // namespace

Eigen::VectorXd lumped_mass(const Mesh& mesh, double density) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * mesh.nodes.size()));
  for (const auto& element : mesh.elements) {
    std::vector<Eigen::Vector2d> corners;
    for (const int node : element) corners.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    const Eigen::VectorXd share = element_mass(corners);
    for (std::size_t a = 0; a < element.size(); ++a)
      mass.segment<2>(2 * element[a]).array() += density * share(static_cast<Eigen::Index>(a));
  }
  return mass;
}

}  // namespace verification
