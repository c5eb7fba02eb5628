// Boundary options of a material file.
#pragma once

#include <array>
#include <optional>

namespace grainlaw::core {

enum class BoundaryType { periodic_cell, frame_p, frame_d, frame_t, mixed };
enum class BoundaryMethod { direct, servo };
enum class ContactWeight { copies, one };

// Rule for the boundary particles of one side in one direction (Liu, Bosco & Suiker 2017, section
// 2.3). d: no fluctuation; p: the fluctuation of the opposite side; t: free under a uniform stress.
enum class SideRule { d, p, t };
enum class SideRotation { fixed, periodic, free };
// Whether the particles within a frame turn (Liu, Bosco & Suiker 2019, section 4.3.2).
enum class InnerRotation { free, fixed };
// Kind of row along a side. discs: separate particles. rigid: one body that follows F as a straight
// line, without contacts within it. A jagged row of prescribed discs is an elastic skeleton under
// F12, which dominates the stress at low pressure.
enum class SideRow { discs, rigid };

struct Side {
  SideRule x = SideRule::p;
  SideRule y = SideRule::p;
  SideRotation rotation = SideRotation::periodic;
  SideRow row = SideRow::discs;

  [[nodiscard]] SideRule rule(int direction) const { return direction == 0 ? x : y; }
  [[nodiscard]] bool shared() const {
    return x == SideRule::p || y == SideRule::p || rotation == SideRotation::periodic;
  }
};

// Sides in the order of the frame: anticlockwise from corner 0.
enum SideName { bottom_side, right_side, top_side, left_side };
using Sides = std::array<Side, 4>;

// The published servo, Liu, Bosco & Suiker (2017) Tables 2-5. Gains are dimensionless, for the
// lightest boundary particle, and scale with 1/M as in the paper. g_a = gain_force / kn, g_m =
// gain_moment / (kn R^2). Table 4 means about 0.25 and 0.5.
struct ServoOptions {
  double gain_force = 0.2;              // stable below 0.3 [-]
  double gain_moment = 0.4;             // [-]
  double gain_deformation = 0.5;        // T: share of the full correction of F [-]
  double inheritance = 1;               // n_f; 0 is the algorithm without prediction (Table 3) [-]
  double tolerance = 1e-6;              // eps_a on the residual r_a (Table 2, 1.5) [-]
  double tolerance_deformation = 1e-6;  // T: eps_F on |F - (1/V) sum x (x) A| [-]
  int max_corrections = 20000;          // per increment [-]
};

struct BoundaryOptions {
  BoundaryType type = BoundaryType::periodic_cell;
  BoundaryMethod method = BoundaryMethod::direct;
  ContactWeight weight = ContactWeight::copies;  // of contacts on a side
  Sides sides;                                   // rules of a mixed boundary
  InnerRotation inner_rotation = InnerRotation::free;
  std::array<std::optional<double>, 4> stress;  // components of P that are prescribed there [Pa]
  ServoOptions servo;
};

// Rules of the four sides, for any type of frame.
inline Sides sides_of(const BoundaryOptions& options) {
  Sides sides = options.sides;
  if (options.type == BoundaryType::frame_d) {
    sides.fill({SideRule::d, SideRule::d, SideRotation::fixed});
  } else if (options.type == BoundaryType::frame_t) {
    sides.fill({SideRule::t, SideRule::t, SideRotation::free});
  } else if (options.type == BoundaryType::frame_p) {
    sides.fill({});
  }
  return sides;
}

}  // namespace grainlaw::core
