#include "material/boundary_keys.hpp"

#include <string_view>

namespace grainlaw::core {

namespace {

ServoOptions read_servo(TomlTable table) {
  ServoOptions servo;
  table.optional("gain_force", number_above(0), servo.gain_force);
  table.optional("gain_moment", number_above(0), servo.gain_moment);
  table.optional("gain_deformation", number_above_up_to(0, 1), servo.gain_deformation);
  table.optional("inheritance", number_between(0, 1), servo.inheritance);
  table.optional("tolerance", number_above(0), servo.tolerance);
  table.optional("tolerance_deformation", number_above(0), servo.tolerance_deformation);
  table.optional("max_corrections", integer_between(1, 1000000000), servo.max_corrections);
  table.finish();
  return servo;
}

// Fails for combinations of rules that are not implemented, at their place in the file.
void check_side(const TomlTable& table, const Side& side) {
  const bool p = side.x == SideRule::p || side.y == SideRule::p;
  const bool t = side.x == SideRule::t || side.y == SideRule::t;
  if (p && t) {
    table.fail(side.x == SideRule::t ? "x" : "y", "\"T\" beside \"P\" in the other direction",
               "\"P\" or \"D\": particles of a \"P\" side move as those of the opposite side");
  }
  if (p && side.rotation == SideRotation::free) {
    table.fail("rotation", "\"free\" on a \"P\" side", "\"periodic\" or \"fixed\"");
  }
  if (t && side.rotation == SideRotation::periodic) {
    table.fail("rotation", "\"periodic\" on a \"T\" side", "\"free\" or \"fixed\"");
  }
  if (side.row == SideRow::rigid && (p || (side.x == SideRule::t && side.y == SideRule::t))) {
    table.fail("row", "\"rigid\" on a side that is nowhere \"D\"",
               "\"D\" in x or y with it, and no \"P\"");
  }
}

// Reads a side: y defaults to the rule of x, and rotations to the rule of the translations.
Side read_side(TomlTable table) {
  const auto rule = one_of<SideRule>({{"D", SideRule::d}, {"P", SideRule::p}, {"T", SideRule::t}});
  Side side;
  table.required("x", rule, side.x);
  side.y = side.x;
  table.optional("y", rule, side.y);
  const bool p = side.x == SideRule::p || side.y == SideRule::p;
  const bool t = side.x == SideRule::t || side.y == SideRule::t;
  side.rotation = p ? SideRotation::periodic : t ? SideRotation::free : SideRotation::fixed;
  table.optional("rotation",
                 one_of<SideRotation>({{"fixed", SideRotation::fixed},
                                       {"periodic", SideRotation::periodic},
                                       {"free", SideRotation::free}}),
                 side.rotation);
  table.optional("row", one_of<SideRow>({{"discs", SideRow::discs}, {"rigid", SideRow::rigid}}),
                 side.row);
  table.finish();
  check_side(table, side);
  return side;
}

void check_opposite(TomlTable& table, std::string_view name, const Side& one,
                    std::string_view opposite, const Side& other) {
  if (!one.shared() && !other.shared()) return;
  if (one.x == other.x && one.y == other.y && one.rotation == other.rotation) return;
  table.fail(name, "another rule than on the opposite side",
             "the same on " + std::string(opposite) +
                 ", since \"P\" and \"periodic\" hold two opposite sides together");
}

void read_sides(TomlTable& table, BoundaryOptions& boundary) {
  auto& sides = boundary.sides;
  sides[left_side] = read_side(table.required_table("left"));
  sides[right_side] = read_side(table.required_table("right"));
  sides[bottom_side] = read_side(table.required_table("bottom"));
  sides[top_side] = read_side(table.required_table("top"));
  check_opposite(table, "left", sides[left_side], "right", sides[right_side]);
  check_opposite(table, "bottom", sides[bottom_side], "top", sides[top_side]);
  if (!table.has("stress")) return;
  TomlTable stress = table.required_table("stress");
  constexpr std::array<std::string_view, 4> names{"P11", "P12", "P21", "P22"};
  for (std::size_t k = 0; k < 4; ++k) {
    boundary.stress[k] = stress.optional(names[k], any_number());
  }
  stress.finish();
  if (boundary.stress[0] && boundary.stress[1] && boundary.stress[2] && boundary.stress[3]) {
    table.fail("stress", "all four components",
               "at most three: stress alone does not say how far the packing turns");
  }
}

}  // namespace

BoundaryOptions read_boundary(TomlTable table) {
  BoundaryOptions boundary;
  table.optional("type",
                 one_of<BoundaryType>({{"periodic-cell", BoundaryType::periodic_cell},
                                       {"frame-p", BoundaryType::frame_p},
                                       {"frame-d", BoundaryType::frame_d},
                                       {"frame-t", BoundaryType::frame_t},
                                       {"mixed", BoundaryType::mixed}}),
                 boundary.type);
  table.optional("method",
                 one_of<BoundaryMethod>(
                     {{"direct", BoundaryMethod::direct}, {"servo", BoundaryMethod::servo}}),
                 boundary.method);
  table.optional(
      "contact_weight",
      one_of<ContactWeight>({{"copies", ContactWeight::copies}, {"one", ContactWeight::one}}),
      boundary.weight);
  table.optional(
      "inner_rotation",
      one_of<InnerRotation>({{"free", InnerRotation::free}, {"fixed", InnerRotation::fixed}}),
      boundary.inner_rotation);
  boundary.servo = read_servo(table.optional_table("servo"));
  if (boundary.type == BoundaryType::mixed) read_sides(table, boundary);
  table.finish();
  if (boundary.method == BoundaryMethod::direct && table.has("servo"))
    table.fail("servo", "a table", "none with method = \"direct\"");
  if (boundary.method == BoundaryMethod::servo && boundary.type == BoundaryType::periodic_cell)
    table.fail("method", "\"servo\" on a periodic cell", "a frame or mixed type with it");
  if (boundary.inner_rotation == InnerRotation::fixed &&
      boundary.type == BoundaryType::periodic_cell)
    table.fail("inner_rotation", "\"fixed\" in a periodic cell",
               "a frame or mixed type with it, or contact.rotation = false");
  return boundary;
}

}  // namespace grainlaw::core
