// The unknowns of a finite element model: what is left of its displacement components.
#pragma once

#include "fe/conditions/linkage.hpp"

#include <Eigen/Dense>

#include <vector>

namespace verification {

struct Model;

// Displacement components are numbered dof = 2 * node + component. Each is the value of one unknown
// or of none, plus programs of prescribed displacements and jumps; tied components share an unknown.
struct Dofs {
  struct Prescribed {
    int dof;
    std::size_t program;  // entry of `programs`
    double factor;
  };

  std::vector<int> unknown;  // [dofs] number of its unknown, -1: none
  std::vector<Prescribed> prescribed;
  std::vector<Program> programs;  // [m]
  int unknowns = 0;

  // Values of the unknowns as a field over all components, programs zero.
  [[nodiscard]] Eigen::VectorXd expand(const Eigen::VectorXd& reduced) const;
  // Forces on the unknowns: the sum over the components that follow each.
  [[nodiscard]] Eigen::VectorXd reduce(const Eigen::VectorXd& full) const;
  // Programs at this time, unknowns zero [m].
  [[nodiscard]] Eigen::VectorXd prescribed_at(double time) const;
};

// Throws InputError for conditions that contradict each other.
Dofs number_dofs(const Model& model);

}  // namespace verification
