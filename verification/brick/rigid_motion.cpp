#include "brick/rigid_motion.hpp"

#include "brick/model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification {
namespace {

using Motion =
    Eigen::Matrix<double, 6, 1>;  // translation, then rotation times the size of the body

// A motion is free when the conditions resist it this much less than a translation of one node.
constexpr double small = 1e-9;

std::string direction(const Eigen::Vector3d& vector) {
  constexpr double along = 1 - 1e-6;
  for (int i = 0; i < 3; ++i)
    if (std::abs(vector(i)) > along * vector.norm()) return std::string(1, "xyz"[i]);
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", vector(0), vector(1), vector(2));
}

std::string text(const Motion& motion) {
  constexpr double none = 1e-6;
  const Eigen::Vector3d rotation = motion.tail<3>();
  return rotation.norm() < none ? "translation along " + direction(motion.head<3>())
                                : "rotation about an axis along " + direction(rotation);
}

// Displacement of every component under the six motions.
Eigen::Matrix<double, Eigen::Dynamic, 6> motions_of(const BrickMesh& mesh) {
  Eigen::Vector3d low = mesh.nodes.front(), high = low;
  for (const auto& node : mesh.nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  Eigen::Matrix<double, Eigen::Dynamic, 6> motions(3 * static_cast<Eigen::Index>(mesh.nodes.size()),
                                                   6);
  Eigen::Index row = 0;
  for (const auto& node : mesh.nodes) {
    const Eigen::Vector3d arm = (node - 0.5 * (low + high)) / (high - low).norm();
    for (int i = 0; i < 3; ++i, ++row) {
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
      motions.row(row) << unit.transpose(), arm.cross(unit).transpose();
    }
  }
  return motions;
}

}  // namespace

std::string free_motion(const BrickModel& model) {
  const BrickUnknowns unknowns(model);
  const auto motions = motions_of(model.mesh);
  // Components that share an unknown follow the mean of a motion; prescribed ones do not follow.
  std::vector<Motion> mean(static_cast<std::size_t>(unknowns.count), Motion::Zero());
  std::vector<int> shared(mean.size());
  const auto for_each_follower = [&](auto&& visit) {
    for (std::size_t k = 0; k < unknowns.number.size(); ++k)
      if (unknowns.number[k] >= 0)
        visit(static_cast<Eigen::Index>(k), static_cast<std::size_t>(unknowns.number[k]));
  };
  for_each_follower([&](Eigen::Index k, std::size_t unknown) {
    mean[unknown] += motions.row(k).transpose();
    ++shared[unknown];
  });
  Eigen::Matrix<double, Eigen::Dynamic, 6> rest = motions;
  for_each_follower([&](Eigen::Index k, std::size_t unknown) {
    rest.row(k) -= mean[unknown].transpose() / shared[unknown];
  });
  const Eigen::Matrix<double, 6, 6> resistance = rest.transpose() * rest;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> modes(resistance);
  const auto& values = modes.eigenvalues();
  const auto free =
      std::count_if(values.begin(), values.end(), [](double value) { return value <= small; });
  if (free == 0) return {};
  return free == 1 ? text(modes.eigenvectors().col(0))
                   : fmt::format("{} independent rigid motions", free);
}

}  // namespace verification
