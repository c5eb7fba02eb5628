// Equations of one Newton iteration over all displacement components.
#pragma once

#include "fe/conditions/dofs.hpp"
#include "fe/model.hpp"

#include <Eigen/SparseCore>

namespace verification {

// Residual and stiffness over all displacement components.
struct System {
  Eigen::VectorXd residual;  // external minus internal force [N/m]
  Eigen::SparseMatrix<double> stiffness;
  double scale = 1;  // |internal force| [N/m]
};
System assemble(const Model& model, const PointField& points, const Eigen::VectorXd& displacement,
                double time);

// Displacement change of the linearised system with its prescribed part given; NaN for a singular
// stiffness.
Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& residual,
                      const Dofs& dofs, const Eigen::VectorXd& prescribed);

}  // namespace verification
