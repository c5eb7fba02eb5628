#include "fe/mesh/mass.hpp"

namespace verification {

Eigen::VectorXd lumped_mass(const Mesh& mesh, double density) {
  // Squared shape functions need more than the one point of q4r.
  const ElementKind rule = mesh.kind == ElementKind::q4r ? ElementKind::q4 : mesh.kind;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(mesh.dofs());
  for (const auto& element : mesh.elements) {
    NodeValues share = NodeValues::Zero(static_cast<Eigen::Index>(element.size()));
    double volume = 0;
    for (const QuadPoint& point : quad_points(rule, mesh.positions(element))) {
      share += point.weight * point.shape.cwiseAbs2();
      volume += point.weight;
    }
    share *= density * volume / share.sum();
    for (std::size_t a = 0; a < element.size(); ++a)
      mass.segment(mesh.dof(element[a], 0), mesh.dimension()).array() +=
          share(static_cast<Eigen::Index>(a));
  }
  return mass;
}

}  // namespace verification
