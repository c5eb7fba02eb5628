// Loads on element sides: pressure and tractions.
#pragma once

#include "fe/conditions/program.hpp"
#include "fe/mesh/mesh.hpp"

#include <Eigen/Sparse>

#include <string>
#include <vector>

namespace verification {

// As Cauchy pressure it stays normal to the deformed sides and acts on their length; as a dead load
// it keeps the force it has on the undeformed ones.
struct Pressure {
  std::vector<Side> sides;
  Program value;  // [Pa]
  bool follows = true;
  std::string place = {};  // in the scene, for messages
};

// Dead load: force per reference area.
struct Traction {
  std::vector<Side> sides;
  int component = 0;
  Program value;           // [Pa]
  std::string place = {};  // in the scene, for messages
};

struct Loads {
  std::vector<Pressure> pressures;
  std::vector<Traction> tractions;
};

using Triplets = std::vector<Eigen::Triplet<double>>;

// Adds the nodal forces of the loads at this time [N/m] and, when wanted, minus
// their derivative with respect to the displacements, which is exact.
void add_loads(const Loads& loads, double time, const Mesh& mesh,
               const Eigen::VectorXd& displacement, Eigen::VectorXd& force, Triplets* stiffness);

}  // namespace verification
