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
// of a platen they may be prescribed, all together.
struct Tie {
  std::vector<int> nodes;
  int component = 0;
  std::string set = {};
  std::string place = {};
  bool platen = false;
};

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
  int node = 0;  // one of the nodes
  std::string place = {};
};

inline const char* component_name(int component) { return component == 0 ? "x" : "y"; }

}  // namespace verification
