// What tables tell of every condition on displacements: how it moves, and the force that it takes.
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
  int resultant = -1;  // entry of Model::resultants that loads the nodes
  bool angle = false;  // an angle and a moment instead
};

struct Monitored {
  double displacement;  // [m], or angle [rad]
  double force;         // per metre of thickness [N/m], or moment [N]
};

// Of every prescribed displacement, every tie or platen, and every jump of periodic sides (there
// the force that the first side exerts on the second), in this order; after a platen that turns
// "NAME_hinge", its angle and the moment on it.
std::vector<Monitor> make_monitors(const Model& model);

// What the columns of a table are called: the motion and the force.
std::array<std::string, 2> columns(const Monitor& monitor);

// imbalance: external minus internal (and inertial) nodal forces at this time [N/m].
Monitored monitored(const Monitor& monitor, const Model& model, double time,
                    const Eigen::VectorXd& displacement, const Eigen::VectorXd& imbalance);

}  // namespace verification
