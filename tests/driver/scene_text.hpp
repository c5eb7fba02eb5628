// Parts of the scene files that several tests write.
#pragma once

namespace verification {

// Thirty discs: tenths of a millisecond a point and step.
inline constexpr const char* small_packing = R"(
[material]
dimension = 2
thickness = 0.1
packing = { generator = "compaction", count = 30, radii = [4e-3, 9e-3], seed = 3, pressure = 1e5, friction = 0.3 }
contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5 }
boundary = { type = "periodic-cell" }
solver = { start = "trial", contacts_lost = "stress_free" }
)";

// One element wide and two high, 0.5 m x 1 m.
inline constexpr const char* narrow_mesh = R"(
[mesh]
size = [0.5, 1.0]
divisions = [1, 2]
)";

// Smooth supports.
inline constexpr const char* bottom_and_left = R"(
[[displacement]]
on = "left"
component = "x"
value = 0.0

[[displacement]]
on = "bottom"
component = "y"
value = 0.0
)";

// A rough support.
inline constexpr const char* held_bottom = R"(
[[displacement]]
on = "bottom"
component = "x"
value = 0.0

[[displacement]]
on = "bottom"
component = "y"
value = 0.0
)";

}  // namespace verification
