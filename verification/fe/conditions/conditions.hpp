// Conditions on the displacements of a finite element model.
#pragma once

#include "fe/conditions/program.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace verification {

struct PrescribedDisplacement {
  std::vector<int> nodes;
  int component = 0;
  Program value;           // [m]
  std::string name;        // for tables, e.g. "top_y"
  std::string set = {};    // the nodes' set
  std::string place = {};  // in the scene, for messages
};

// The nodes move by the same amount in this component, as if glued to a rigid smooth plate. As part
// of a platen they may be prescribed, all together. A platen on a hinge turns as well, by a small
// angle: u = motion of the hinge + angle * arm, and no moment acts on it.
struct Tie {
  std::vector<int> nodes;
  int component = 0;
  std::string set = {};
  std::string place = {};
  bool platen = false;
  std::vector<double> arms = {};  // of the nodes about the hinge, signed so that angles are
                                  // anticlockwise [m]; empty: it does not turn
};

// Nodes with weights: what they stand for is the weighted sum of a displacement component.
using Weights = std::vector<std::pair<int, double>>;

// Motion of the hinge, or of any node where nothing turns; and the angle of a tie that turns [rad].
Weights hinge_weights(const Tie& tie);
Weights angle_weights(const Tie& tie);

// u(second) = u(first) + jump for every pair of nodes.
struct Periodic {
  std::vector<std::pair<int, int>> pairs;
  std::array<std::optional<Program>, 2> jump;  // [m], without: 0
  std::string name;                            // for tables, e.g. "left_right"
  std::string place = {};
};

// Total force on nodes that move together in this component, per metre of thickness [N/m].
struct Resultant {
  std::string set;
  int component = 0;
  Program value;
  Weights nodes;  // that carry it
  std::string place = {};
};

inline const char* component_name(int component) { return component == 0 ? "x" : "y"; }

}  // namespace verification
