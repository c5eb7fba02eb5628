// Conditions on the displacements of a finite element model.
#pragma once

#include "fe/conditions/program.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace verification {

struct PrescribedDisplacement {
  std::vector<int> nodes;
  int component = 0;
  Program value;           // [m]
  std::string name;        // for tables, e.g. "top_y"
  std::string set = {};    // set of the nodes
  std::string place = {};  // place in the scene, for messages
};

// Nodes with equal displacement in this component, as on a rigid smooth plate. In a platen they may
// be prescribed together. A platen on a hinge also rotates by a small angle: u = displacement of
// the hinge + angle * arm, with no moment on it.
struct Tie {
  std::vector<int> nodes;
  int component = 0;
  std::string set = {};
  std::string place = {};
  bool platen = false;
  std::vector<double> arms = {};  // from the hinge, anticlockwise [m]; empty: no rotation
};

// Nodes with weights: a weighted sum of a displacement component.
using Weights = std::vector<std::pair<int, double>>;

// Weights of the hinge's displacement, or of any node where nothing rotates; and of the angle of a
// rotating tie [rad].
Weights hinge_weights(const Tie& tie);
Weights angle_weights(const Tie& tie);

// u(second) = u(first) + jump for every pair of nodes.
struct Periodic {
  std::vector<std::pair<int, int>> pairs;
  std::array<std::optional<Program>, 3> jump;  // by components [m]; absent: 0
  std::string name;                            // for tables, e.g. "left_right"
  std::string place = {};
};

// Total force on the nodes of a tie in this component, in the plane per metre of thickness [N/m], of
// solids [N].
struct Resultant {
  std::string set;
  int component = 0;
  Program value;
  Weights nodes;  // nodes that carry it
  std::string place = {};
};

// The first `dimension` names of axes.
inline std::vector<std::string_view> component_names(int dimension) {
  return dimension == 2 ? std::vector<std::string_view>{"x", "y"}
                        : std::vector<std::string_view>{"x", "y", "z"};
}
inline char component_name(int component) { return "xyz"[component]; }

}  // namespace verification
