// The contact law of a material: stiffness from moduli, friction, and what may rotate.
#pragma once

namespace grainlaw {

enum class LawKind { frictional };

struct ContactLaw {
  LawKind kind = LawKind::frictional;
  double young = 0;             // kn = young * 2 Ri Rj / (Ri + Rj), Guo & Zhao eq. 14 [Pa]; or
  double normal_stiffness = 0;  // kn itself, used when young is 0 [N/m]
  double ratio = 0;             // kt / kn [-]
  double friction = 0;          // tan(phi) [-]
  bool rotation = true;         // false: particles keep their orientation

  // Normal stiffness of a contact between radii a and b [N/m].
  [[nodiscard]] double stiffness(double a, double b) const {
    return young > 0 ? young * 2 * a * b / (a + b) : normal_stiffness;
  }
  // Tangential springs act: there is friction and stiffness.
  [[nodiscard]] bool tangential() const { return friction > 0 && ratio > 0; }
  // Particle rotations are unknowns.
  [[nodiscard]] bool rotating() const { return tangential() && rotation; }
};

}  // namespace grainlaw
