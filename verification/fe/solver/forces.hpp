// Forces on a finite element model for every solver: the only list of loads and supports.
#pragma once

#include "fe/solver/solver.hpp"

namespace verification {

// Adds the nodal forces of all loads at this time [N/m]. With `stiffness`, also minus their
// derivative by the displacements.
void add_external_force(const Model& model, double time, const Eigen::VectorXd& displacement,
                        Eigen::VectorXd& force, Triplets* stiffness = nullptr);

// Sets displacements and reactions of the step, from external minus internal (and inertial) nodal
// forces at this time [N/m].
void report_supports(const Model& model, double time, const Eigen::VectorXd& displacement,
                     const Eigen::VectorXd& imbalance, LoadStep& step);

}  // namespace verification
