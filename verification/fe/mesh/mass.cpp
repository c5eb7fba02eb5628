#include "fe/mesh/mass.hpp"

namespace verification {

Eigen::VectorXd lumped_mass(const Mesh& mesh, double density) {
  // Squared shape functions need more than the one point of q4r.
  const ElementKind rule = mesh.kind == ElementKind::q4r ? ElementKind::q4 : mesh.kind;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * mesh.nodes.size()));
  for (const auto& element : mesh.elements) {
    NodeValues share = NodeValues::Zero(static_cast<Eigen::Index>(element.size()));
    double area = 0;
    for (const QuadPoint& point : quad_points(rule, mesh.positions(element))) {
      share += point.weight * point.shape.cwiseAbs2();
      area += point.weight;
    }
    share *= density * area / share.sum();
    for (std::size_t a = 0; a < element.size(); ++a)
      mass.segment<2>(2 * element[a]).array() += share(static_cast<Eigen::Index>(a));
  }
  return mass;
}

}  // namespace verification
