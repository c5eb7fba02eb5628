#include "fe/solver/linear_system.hpp"

#include "fe/solver/forces.hpp"

#include <Eigen/SparseLU>

#include <algorithm>
#include <limits>

namespace verification {

System assemble(const Model& model, const PointField& points, const Eigen::VectorXd& displacement,
                double time) {
  System system;
  Triplets triplets;
  const Eigen::VectorXd internal = points.internal_force();
  system.residual = -internal;
  points.add_stiffness(triplets);
  add_external_force(model, time, displacement, system.residual, &triplets);
  system.stiffness.resize(internal.size(), internal.size());
  system.stiffness.setFromTriplets(triplets.begin(), triplets.end());
  system.scale = std::max(internal.norm(), std::numeric_limits<double>::min());
  return system;
}

Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& residual,
                      const Dofs& dofs, const Eigen::VectorXd& prescribed) {
  const Eigen::VectorXd force = dofs.reduce(residual - stiffness * prescribed);
  Triplets triplets;
  for (int column = 0; column < stiffness.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(stiffness, column); entry; ++entry)
      dofs.follow(static_cast<std::size_t>(entry.row()), [&](int i, double row_factor) {
        dofs.follow(static_cast<std::size_t>(entry.col()), [&](int k, double column_factor) {
          triplets.emplace_back(i, k, row_factor * entry.value() * column_factor);
        });
      });
  Eigen::SparseMatrix<double> reduced(dofs.unknowns, dofs.unknowns);
  reduced.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(reduced);
  if (factor.info() != Eigen::Success)
    return Eigen::VectorXd::Constant(prescribed.size(), std::numeric_limits<double>::quiet_NaN());
  return prescribed + dofs.expand(factor.solve(force));
}

}  // namespace verification
