// Contact law of a material: stiffness, friction, bonds, rolling, and whether particles rotate.
#pragma once

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

// Laws by their sources.
//   compressive  fn = kn overlap, no other force [liu2018_waves, eq. 4.7];
//   frictional   [liu2017_boundary, eq. 6];
//   bonded       [liu2017_boundary, eqs. 7 and 8] until a bond breaks, then frictional;
//   hertz        Hertz-Mindlin [guo2014_multiscale, after eq. 9].
enum class LawKind { frictional, compressive, bonded, hertz };

// Rolling resistance: a spring between the rotations of two discs, with r = 2 Ri Rj / (Ri + Rj). kr
// = ratio kt r^2 and |m| <= friction r fn. @formula rolling Spheres have another spring about the
// branch, with its own ratio and bound.
struct RollingResistance {
  double ratio = 0;              // [-]
  double friction = 0;           // [-]
  double twisting_ratio = 0;     // [-]
  double twisting_friction = 0;  // [-]
};

// Bond with springs of its own or the contact's kn and kt, in tension too, and a bending spring;
// between spheres also a torsion spring about the branch. It breaks when the sum of its loads over
// their strengths reaches 1, fn positive in tension. @formula bond
struct Bond {
  double normal_stiffness = 0;      // 0, both: kn and kt of the contact [N/m]
  double tangential_stiffness = 0;  // [N/m]
  double normal_strength = 0;       // [N]
  double tangential_strength = 0;   // [N]
  double bending_strength = 0;      // [N m], 0: bonds do not bend
  double bending_stiffness = 0;     // [N m / rad]
  double torsion_strength = 0;      // [N m], 0: bonds do not twist
  double torsion_stiffness = 0;     // [N m / rad]
  double gap = 0;                   // discs within this distance at F = I are bonded [m]
};

struct ContactLaw {
  LawKind kind = LawKind::frictional;
  double young = 0;  // kn = young * 2 Ri Rj / (Ri + Rj) [guo2014_multiscale, eq. 14] [Pa]; or
  double normal_stiffness = 0;  // kn itself, if young is 0 [N/m]
  double ratio = 0;             // kt / kn; Hertz-Mindlin: 2 (1 - poisson) / (2 - poisson) [-]
  double friction = 0;          // tan(phi) [-]
  bool rotation = true;         // false: particles keep their orientation
  double shear_modulus = 0;     // Hertz-Mindlin [Pa]
  double poisson = 0;           // Hertz-Mindlin [-]
  RollingResistance rolling;
  Bond bond;
  // Overlap over common radius at which the solver takes the stiffness of a Hertz-Mindlin contact;
  // that of the packing at F = I [-].
  double typical_overlap = 1e-3;

  // The law by which bonds that hold bear; this one, where bonds have no springs of their own.
  [[nodiscard]] ContactLaw of_bonds() const {
    ContactLaw law = *this;
    if (bond.normal_stiffness == 0) return law;
    law.young = 0;
    law.normal_stiffness = bond.normal_stiffness;
    law.ratio = bond.tangential_stiffness / bond.normal_stiffness;
    return law;
  }

  // Common radius 2 a b / (a + b) [m].
  [[nodiscard]] static double common_radius(double a, double b) { return 2 * a * b / (a + b); }

  // Normal stiffness of a contact between radii a and b [N/m]. @formula stiffness
  [[nodiscard]] double stiffness(double a, double b) const {
    if (hertzian()) return coefficient(a, b) * std::sqrt(typical_overlap * common_radius(a, b));
    return young > 0 ? young * 2 * a * b / (a + b) : normal_stiffness;
  }
  // Normal stiffness of the stiffer of a contact and a bond [N/m].
  [[nodiscard]] double largest_stiffness(double a, double b) const {
    return std::max(stiffness(a, b), of_bonds().stiffness(a, b));
  }
  // Coefficient of listed contacts: kn [N/m], or for Hertz-Mindlin kn / sqrt(overlap) = G / (1 -
  // poisson) sqrt(2 r) [N/m^1.5]. @formula hertz
  [[nodiscard]] double coefficient(double a, double b) const {
    if (!hertzian()) return stiffness(a, b);
    return shear_modulus / (1 - poisson) * std::sqrt(2 * common_radius(a, b));
  }
  // Normal force between radii a and b [N]; overlap is negative in tension, which bonds alone
  // transmit.
  [[nodiscard]] double normal_force(double a, double b, double overlap) const {
    const double root = hertzian() ? std::sqrt(overlap > 0 ? overlap : 0) : 1;
    return (hertzian() ? 2.0 / 3 : 1) * coefficient(a, b) * root * overlap;
  }
  // Energy of the contact's springs [J], from the squares of tangential force and of moments across
  // and along the branch. `bonded`: with a bond's springs of bending and torsion.
  [[nodiscard]] double energy(double a, double b, double overlap, double tangential_square,
                              double moment_square, double twisting_square, bool bonded) const {
    const double kn =
        hertzian() ? coefficient(a, b) * std::sqrt(overlap > 0 ? overlap : 0) : coefficient(a, b);
    const double kr = bonded ? bond.bending_stiffness : rolling_ratio(a, b) * ratio * kn;
    double sum = (hertzian() ? 4.0 / 15 : 0.5) * kn * overlap * overlap;
    if (tangential_square != 0) sum += 0.5 * tangential_square / (ratio * kn);
    if (moment_square != 0 && kr > 0) sum += 0.5 * moment_square / kr;
    if (twisting_square != 0) {
      const double twisting = bonded ? bond.torsion_stiffness : twisting_ratio(a, b) * ratio * kn;
      if (twisting > 0) sum += 0.5 * twisting_square / twisting;
    }
    return sum;
  }
  // kr / kt of contacts without a bond [m^2]. @formula rolling
  [[nodiscard]] double rolling_ratio(double a, double b) const {
    const double r = common_radius(a, b);
    return rolls() ? rolling.ratio * r * r : 0;
  }

  // Stiffness about the branch over kt, for contacts without a bond [m^2].
  [[nodiscard]] double twisting_ratio(double a, double b) const {
    const double r = common_radius(a, b);
    return twists() ? rolling.twisting_ratio * r * r : 0;
  }

  [[nodiscard]] bool hertzian() const { return kind == LawKind::hertz; }
  [[nodiscard]] bool bonds() const { return kind == LawKind::bonded; }
  // True if tangential springs act: there is friction (or a bond) and stiffness.
  [[nodiscard]] bool tangential() const { return ratio > 0 && (friction > 0 || bonds()); }
  // True if particle rotations are unknowns.
  [[nodiscard]] bool rotating() const { return tangential() && rotation; }
  [[nodiscard]] bool rolls() const {
    return rotating() && rolling.ratio > 0 && rolling.friction > 0;
  }
  [[nodiscard]] bool twists() const {
    return rotating() && rolling.twisting_ratio > 0 && rolling.twisting_friction > 0;
  }
  // True if contacts transmit moments.
  [[nodiscard]] bool moments() const { return rolls() || (rotating() && bonds()); }
  // True for linear laws without bonds and moments, which have the shortest loops.
  [[nodiscard]] bool plain() const { return !hertzian() && !bonds() && !moments(); }
};

}  // namespace grainlaw::core
