// The equations of one Newton iteration over all displacement components.
#pragma once

#include "fe/conditions/dofs.hpp"
#include "fe/model.hpp"

#include <Eigen/SparseCore>

namespace verification {

// Residual and stiffness of all displacement components at one displacement and one load.
struct System {
  Eigen::VectorXd residual;  // external minus internal force [N/m]
  Eigen::SparseMatrix<double> stiffness;
  double scale = 1;  // |internal force| [N/m]
};
System assemble(const Model& model, const PointField& points, const Eigen::VectorXd& displacement,
                double time);

// Change of displacement that the linearised system asks for, the prescribed part given. NaN where
// the stiffness is singular.
Eigen::VectorXd solve(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& residual,
                      const Dofs& dofs, const Eigen::VectorXd& prescribed);

}  // namespace verification
