// Conditions on the displacements of a finite element model: prescribed and tied components.
#pragma once

#include "fe/conditions/program.hpp"

#include <Eigen/Dense>

#include <cstddef>
#include <string>
#include <vector>

namespace verification {

// Displacement components are numbered dof = 2 * node + component.
//
// Every component is either prescribed or follows one unknown; tied components share theirs.
struct Dofs {
  std::vector<int> unknown;       // [dofs] number of its unknown, -1: prescribed
  std::vector<int> program;       // [dofs] entry of `programs` that prescribes it, -1: none
  std::vector<Program> programs;  // [m]
  int unknowns = 0;

  // Values of the unknowns as a field over all components, prescribed ones zero.
  [[nodiscard]] Eigen::VectorXd expand(const Eigen::VectorXd& reduced) const;
  // Forces on the unknowns: the sum over the components that follow each.
  [[nodiscard]] Eigen::VectorXd reduce(const Eigen::VectorXd& full) const;
  // Prescribed displacements at this time, unknowns zero [m].
  [[nodiscard]] Eigen::VectorXd prescribed_at(double time) const;
};

struct PrescribedDisplacement {
  std::vector<int> nodes;
  int component = 0;
  Program value;     // [m]
  std::string name;  // for tables, e.g. "top_y"
};

// The nodes move by the same amount in this component, as if glued to a rigid smooth plate.
struct Tie {
  std::vector<int> nodes;
  int component = 0;
};

// Throws InputError for a component that is tied twice, or tied and prescribed.
Dofs number_dofs(std::size_t nodes, const std::vector<PrescribedDisplacement>& displacements,
                 const std::vector<Tie>& ties);

}  // namespace verification
