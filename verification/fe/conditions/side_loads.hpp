// Loads on element sides: pressure and tractions.
#pragma once

#include "fe/conditions/program.hpp"
#include "fe/mesh/mesh.hpp"

#include <Eigen/Sparse>

#include <string>
#include <vector>

namespace verification {

// A Cauchy pressure is normal to the deformed sides and acts on their length or area; a dead load keeps its
// force on the undeformed sides.
struct Pressure {
  std::vector<Side> sides;
  Program value;  // [Pa]
  bool follows = true;
  std::string place = {};  // place in the scene, for messages
};

// Dead load: force per reference area.
struct Traction {
  std::vector<Side> sides;
  int component = 0;
  Program value;           // [Pa]
  std::string place = {};  // place in the scene, for messages
};

struct Loads {
  std::vector<Pressure> pressures;
  std::vector<Traction> tractions;
};

using Triplets = std::vector<Eigen::Triplet<double>>;

// Adds the nodal forces of the loads at this time [N/m], of solids [N], and, when wanted, minus their exact
// derivative by the displacements.
void add_loads(const Loads& loads, double time, const Mesh& mesh,
               const Eigen::VectorXd& displacement, Eigen::VectorXd& force, Triplets* stiffness);

}  // namespace verification
