// Monitors of displacement conditions: the displacement and force of each, for tables.
#pragma once

#include "fe/conditions/conditions.hpp"

#include <Eigen/Dense>

#include <string>
#include <vector>

namespace verification {

struct Model;

struct Monitor {
  std::string name;  // e.g. "top_y"
  int component = 0;
  Weights motion;      // weighted sum of displacements
  Weights force;       // weighted sum of the forces on the nodes
  int resultant = -1;  // index in Model::resultants of its load
  bool angle = false;  // an angle and a moment
};

struct Monitored {
  double displacement;  // [m], or angle [rad]
  double force;         // per metre of thickness [N/m], of solids [N]; or moment [N]
};

// Monitors of every prescribed displacement, tie or platen, and jump of periodic sides, in this
// order. The force of a jump is that of the first side on the second. A rotating platen has a
// second monitor "NAME_hinge" for its angle and moment.
std::vector<Monitor> make_monitors(const Model& model);

// Unit of forces: "N/m" or "N".
const char* force_unit(int dimension);
// Column names of the displacement and the force.
std::array<std::string, 2> columns(const Monitor& monitor, int dimension);

// Values of a monitor. imbalance: external minus internal (and inertial) nodal forces at this time
// [N/m].
Monitored monitored(const Monitor& monitor, const Model& model, double time,
                    const Eigen::VectorXd& displacement, const Eigen::VectorXd& imbalance);

}  // namespace verification
