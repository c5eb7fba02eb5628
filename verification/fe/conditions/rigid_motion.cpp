#include "fe/conditions/rigid_motion.hpp"

#include "fe/conditions/dofs.hpp"
#include "fe/model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SparseCholesky>

#include <cmath>

namespace verification {
namespace {

// Resistance relative to that of a translation below which a motion counts as free.
constexpr double small = 1e-9;

std::string direction(const Eigen::VectorXd& vector) {
  constexpr double along = 1 - 1e-6;
  std::vector<std::string> components;
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    if (std::abs(vector(i)) > along * vector.norm())
      return std::string(1, component_name(static_cast<int>(i)));
    components.push_back(fmt::format("{:.3g}", vector(i)));
  }
  return fmt::format("({})", fmt::join(components, ", "));
}

// Text of a motion: translations, then rotations times the size of the body.
std::string motion_text(const Eigen::VectorXd& motion, int dimension, double size,
                        const Position& centre) {
  constexpr double none = 1e-6;
  const Eigen::VectorXd rotation = motion.tail(motion.size() - dimension);
  if (rotation.norm() < none) return "translation along " + direction(motion.head(dimension));
  if (dimension == 3) return "rotation about an axis along " + direction(rotation);
  const double angle = rotation(0) / size;  // [rad]
  const auto shown = [&](double coordinate) {
    return std::abs(coordinate) < 1e-9 * size ? 0 : coordinate;
  };
  return fmt::format("rotation about ({:.6g}, {:.6g})", shown(centre.x() - motion(1) / angle),
                     shown(centre.y() + motion(0) / angle));
}

// Displacement of every component under translations and rotations of one over the size.
Eigen::MatrixXd rigid_motions(const Mesh& mesh, double size, const Position& centre) {
  const int dimension = mesh.dimension();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(mesh.dofs(), dimension * (dimension + 1) / 2);
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
    Eigen::Vector3d arm = Eigen::Vector3d::Zero();
    arm.head(dimension) = (mesh.position(node) - centre) / size;
    for (int i = 0; i < dimension; ++i) {
      const Eigen::Index row = mesh.dof(node, i);
      motions(row, i) = 1;
      const Eigen::Vector3d rotations = arm.cross(Eigen::Vector3d::Unit(i));
      if (dimension == 2)
        motions(row, 2) = rotations.z();
      else
        motions.row(row).tail<3>() = rotations;
    }
  }
  return motions;
}

}  // namespace

void check_supports(const Model& model, const std::string& place) {
  const Dofs dofs = number_dofs(model);
  const Mesh& mesh = model.mesh;
  const Position centre = 0.5 * (mesh.low() + mesh.high());
  const double size = (mesh.high() - mesh.low()).norm();
  const Eigen::MatrixXd motions = rigid_motions(mesh, size, centre);
  // Part of a rigid motion that the components cannot follow, by least squares over the unknowns.
  Triplets triplets;
  for (std::size_t d = 0; d < dofs.unknown.size(); ++d)
    dofs.follow(d, [&](int k, double factor) {
      triplets.emplace_back(static_cast<int>(d), k,
                            k == dofs.platen_rotation[d].angle ? factor / size : factor);
    });
  Eigen::SparseMatrix<double> follows(mesh.dofs(), dofs.unknowns);
  follows.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SparseMatrix<double> normal = follows.transpose() * follows;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
  Eigen::MatrixXd rest = motions;
  if (dofs.unknowns > 0) rest -= follows * factor.solve(follows.transpose() * motions);
  const Eigen::MatrixXd supports = rest.transpose() * rest;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(supports);
  const Eigen::Index free = (modes.eigenvalues().array() <= small).count();
  if (free == 0) return;
  const std::string which =
      free == 1 ? motion_text(modes.eigenvectors().col(0), mesh.dimension(), size, centre)
                : fmt::format("{} independent rigid motions", free);
  throw InputError(fmt::format(
      "{}: found nothing that holds {}, expected [[displacement]], [[tie]], [[platen]] or "
      "[[periodic]] that prevent every rigid motion",
      place, which));
}

}  // namespace verification
