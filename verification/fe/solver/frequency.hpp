// The highest natural frequency of a model, which bounds the time step of explicit schemes.
#pragma once

#include "fe/conditions/dofs.hpp"
#include "fe/model.hpp"

namespace verification {

// Largest omega of K x = omega^2 M x [1/s], for the stiffness of the last evaluation [N/m2] and
// lumped masses of the components [kg/m], the supports held. By power iteration from a fixed start,
// which ends slightly below: within 1 % for a bar of 400 elements.
double highest_frequency(const PointField& points, const Dofs& dofs, const Eigen::VectorXd& mass);

}  // namespace verification
