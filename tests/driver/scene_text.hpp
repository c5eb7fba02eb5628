// Parts of the scene files that several tests write.
#pragma once

#include <string>

namespace verification {

// Thirty discs: tenths of a millisecond a point and step.
inline std::string small_packing_of_seed(int seed, const std::string& more_of_solver = "") {
  return R"(
[material]
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 30, radii = [4e-3, 9e-3], seed = )" +
         std::to_string(seed) + R"(, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
boundary = { type = "periodic-cell" }
solver = { start = "trial", contacts_lost = "stress_free")" +
         more_of_solver + " }\n";
}

inline const std::string small_packing = small_packing_of_seed(3);

// One element wide and two high, 0.5 m x 1 m.
inline const std::string narrow_mesh = R"(
[mesh]
size = [0.5, 1.0]
divisions = [1, 2]
)";

// A set of nodes that does not move in this component.
inline std::string held(const std::string& set, const std::string& component) {
  return "[[displacement]]\non = '" + set + "'\ncomponent = '" + component + "'\nvalue = 0.0\n";
}

inline const std::string smooth_supports = held("left", "x") + held("bottom", "y");
inline const std::string held_bottom =
    std::string("\n").append(held("bottom", "x")).append(held("bottom", "y"));
inline const std::string periodic_sides = "[[periodic]]\nsides = ['left', 'right']\n";

}  // namespace verification
