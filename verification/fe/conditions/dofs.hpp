// The unknowns of a finite element model.
#pragma once

#include "fe/conditions/linkage.hpp"

#include <Eigen/Dense>

#include <vector>

namespace verification {

struct Model;

// Displacement components are numbered dof = dimension * node + component. Each is at most one unknown plus
// programs of prescribed displacements and jumps; tied components share an unknown. Those of a
// rotating platen also depend on its angle.
struct Dofs {
  struct PlatenRotation {
    int angle = -1;  // index of its unknown, -1: none
    double arm = 0;  // [m]
  };

  struct Prescribed {
    int dof;
    std::size_t program;  // index in `programs`
    double factor;
  };

  std::vector<int> unknown;                     // [dofs] index of the unknown, -1: none
  std::vector<PlatenRotation> platen_rotation;  // [dofs]
  std::vector<Prescribed> prescribed;
  std::vector<Program> programs;  // [m]
  int unknowns = 0;

  // Calls visit(unknown, factor) for every unknown of the component.
  template <class Visit>
  void follow(std::size_t dof, Visit&& visit) const {
    if (unknown[dof] >= 0) visit(unknown[dof], 1.0);
    if (platen_rotation[dof].angle >= 0)
      visit(platen_rotation[dof].angle, platen_rotation[dof].arm);
  }

  // Values of the unknowns as a field over all components, programs zero.
  [[nodiscard]] Eigen::VectorXd expand(const Eigen::VectorXd& reduced) const;
  // Forces on the unknowns: sums over the components of each.
  [[nodiscard]] Eigen::VectorXd reduce(const Eigen::VectorXd& full) const;
  // Masses of the unknowns, from those of the components. Couplings between the two unknowns of a
  // rotating platen are dropped: they vanish when its mass is centred on the hinge.
  [[nodiscard]] Eigen::VectorXd reduce_mass(const Eigen::VectorXd& full) const;
  [[nodiscard]] bool masses_coupled(const Eigen::VectorXd& full) const;
  // Values of the programs at this time, unknowns zero [m].
  [[nodiscard]] Eigen::VectorXd prescribed_at(double time) const;
};

// Numbers the unknowns. Throws InputError for contradictory conditions.
Dofs number_dofs(const Model& model);

// Throws InputError for a load that acts on prescribed components alone and thus does nothing.
void check_loads_act(const Model& model, const Dofs& dofs);

}  // namespace verification
