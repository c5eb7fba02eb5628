// What tables tell of every condition on displacements: how it moves, and the force that it takes.
#pragma once

#include <Eigen/Dense>

#include <optional>
#include <string>
#include <vector>

namespace verification {

struct Model;

struct Monitor {
  std::string name;        // e.g. "top_y"
  std::vector<int> nodes;  // that the force acts on
  int component = 0;
  int from = -1;       // the motion is that of the first node, less that of this one
  int resultant = -1;  // entry of Model::resultants that loads the nodes
};

struct Monitored {
  double displacement;  // [m]
  double force;         // summed over the nodes, per metre of thickness [N/m]
};

// Of every prescribed displacement, every tie or platen, and every jump of periodic sides (there
// the force that the first side exerts on the second), in this order.
std::vector<Monitor> make_monitors(const Model& model);

// imbalance: external minus internal (and inertial) nodal forces at this time [N/m].
Monitored monitored(const Monitor& monitor, const Model& model, double time,
                    const Eigen::VectorXd& displacement, const Eigen::VectorXd& imbalance);

}  // namespace verification
