// Highest natural frequency of a model, which limits explicit time steps.
#pragma once

#include "fe/conditions/dofs.hpp"
#include "fe/model.hpp"

namespace verification {

// Largest omega of K x = omega^2 M x [1/s] with the supports at rest. K is the last evaluation's
// stiffness [N/m2], M has lumped masses of the components [kg/m]. Power iteration from a fixed
// start ends slightly below: within 1 % for a bar of 400 elements.
double highest_frequency(const PointField& points, const Dofs& dofs, const Eigen::VectorXd& mass);

}  // namespace verification
