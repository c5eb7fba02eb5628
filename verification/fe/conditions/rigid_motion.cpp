#include "fe/conditions/rigid_motion.hpp"

#include "fe/conditions/dofs.hpp"
#include "fe/model.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>

#include <cmath>

namespace verification {
namespace {

// Resistance relative to that of a translation below which a motion counts as free.
constexpr double small = 1e-9;

std::string motion_text(const Eigen::Vector3d& motion, double size, const Eigen::Vector2d& centre) {
  const double rotation = motion(2) / size;  // [rad]
  if (std::abs(motion(2)) < 1e-6) {
    if (std::abs(motion(1)) < 1e-6) return "translation along x";
    if (std::abs(motion(0)) < 1e-6) return "translation along y";
    return fmt::format("translation along ({:.3g}, {:.3g})", motion(0), motion(1));
  }
  const auto shown = [&](double coordinate) {
    return std::abs(coordinate) < 1e-9 * size ? 0 : coordinate;
  };
  return fmt::format("rotation about ({:.6g}, {:.6g})", shown(centre.x() - motion(1) / rotation),
                     shown(centre.y() + motion(0) / rotation));
}

}  // namespace

void check_supports(const Model& model, const std::string& place) {
  const Dofs dofs = number_dofs(model);
  const auto& nodes = model.mesh.nodes;
  Eigen::Vector2d low = nodes.front(), high = nodes.front();
  for (const auto& node : nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  const Eigen::Vector2d centre = 0.5 * (low + high);
  const double size = (high - low).norm();
  // Displacement of a component under translations and a rotation of one over the size.
  const auto motion = [&](std::size_t d) -> Eigen::RowVector3d {
    const Eigen::Vector2d arm = (nodes[d / 2] - centre) / size;
    return d % 2 == 0 ? Eigen::RowVector3d(1, 0, -arm.y()) : Eigen::RowVector3d(0, 1, arm.x());
  };
  // Part of a rigid motion that the components cannot follow, by least squares over the unknowns.
  const auto count = static_cast<Eigen::Index>(dofs.unknown.size());
  Triplets triplets;
  Eigen::MatrixX3d motions(count, 3);
  for (std::size_t d = 0; d < dofs.unknown.size(); ++d) {
    const auto row = static_cast<Eigen::Index>(d);
    motions.row(row) = motion(d);
    dofs.follow(d, [&](int k, double factor) {
      triplets.emplace_back(row, k, k == dofs.platen_rotation[d].angle ? factor / size : factor);
    });
  }
  Eigen::SparseMatrix<double> follows(count, dofs.unknowns);
  follows.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SparseMatrix<double> normal = follows.transpose() * follows;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
  Eigen::MatrixX3d rest = motions;
  if (dofs.unknowns > 0) rest -= follows * factor.solve(follows.transpose() * motions);
  const Eigen::Matrix3d supports = rest.transpose() * rest;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes(supports);
  if (modes.eigenvalues()(0) > small) return;
  int free = 0;
  while (free < 3 && modes.eigenvalues()(free) <= small) ++free;
  const std::string which = free == 1 ? motion_text(modes.eigenvectors().col(0), size, centre)
                                      : fmt::format("{} independent rigid motions", free);
  throw InputError(fmt::format(
      "{}: found nothing that holds {}, expected [[displacement]], [[tie]], [[platen]] or "
      "[[periodic]] that prevent every rigid motion",
      place, which));
}

}  // namespace verification
