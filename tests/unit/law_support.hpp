// Contact laws beyond the reference one, for packings of the size and pressure of the reference.
#pragma once

#include "support.hpp"

namespace grainlaw::core::test {

inline ContactLaw compressive_law() {
  ContactLaw law;
  law.kind = LawKind::compressive;
  law.young = 6e8;
  return law;
}

inline ContactLaw rolling_law() {
  ContactLaw law = rough_law();
  law.rolling = {1.0, 0.1};
  return law;
}

// About as stiff as the linear law at 100 kPa.
inline ContactLaw hertz_law() {
  ContactLaw law;
  law.kind = LawKind::hertz;
  law.shear_modulus = 9e9;
  law.poisson = 0.2;
  law.ratio = 2 * (1 - law.poisson) / (2 - law.poisson);
  law.friction = std::tan(0.5);
  return law;
}

inline ContactLaw smooth_hertz_law() {
  ContactLaw law = hertz_law();
  law.friction = 0;
  return law;
}

inline ContactLaw locked_hertz_law() {
  ContactLaw law = hertz_law();
  law.rotation = false;
  return law;
}

inline ContactLaw rolling_hertz_law() {
  ContactLaw law = hertz_law();
  law.rolling = {1.0, 0.1};
  return law;
}

// Bonds of `strength` times the mean contact force at 100 kPa, about 100 N.
inline ContactLaw bonded_law(double strength) {
  ContactLaw law = rough_law();
  law.kind = LawKind::bonded;
  law.bond.normal_strength = law.bond.tangential_strength = 100 * strength;
  law.bond.bending_stiffness = 20;
  law.bond.bending_strength = 0.2 * strength;
  return law;
}

inline ContactLaw locked_bonded_law(double strength) {
  ContactLaw law = bonded_law(strength);
  law.rotation = false;
  law.bond.bending_stiffness = law.bond.bending_strength = 0;
  return law;
}

inline ContactLaw rolling_bonded_law(double strength) {
  ContactLaw law = bonded_law(strength);
  law.rolling = {1.0, 0.1};
  return law;
}

// The normal springs of its bonds are stiffer than those of its contacts, the tangential ones softer.
inline ContactLaw springy_bonded_law(double strength) {
  ContactLaw law = bonded_law(strength);
  law.bond.normal_stiffness = 4e6;
  law.bond.tangential_stiffness = 1.5e6;
  return law;
}

struct NamedLaw {
  const char* name;
  ContactLaw law;
};
// Those that carry a small packing without friction are tested on the reference packing.
inline std::vector<NamedLaw> composite_laws() {
  return {{"rolling", rolling_law()},
          {"Hertz-Mindlin", hertz_law()},
          {"Hertz-Mindlin, locked", locked_hertz_law()},
          {"Hertz-Mindlin, rolling", rolling_hertz_law()},
          {"bonds that hold", bonded_law(100)},
          {"bonds that break", bonded_law(1)},
          {"bonds, locked", locked_bonded_law(1)},
          {"bonds, then rolling", rolling_bonded_law(1)},
          {"bonds with springs of their own", springy_bonded_law(1)}};
}

// The forces that come with a packing are those of the springs of linear contacts.
inline MaterialDescription describe_law(const Packing& packing, const ContactLaw& law,
                                        BoundaryType boundary = BoundaryType::periodic_cell,
                                        double tolerance = 1e-10) {
  MaterialDescription description = describe(packing, law, boundary, tolerance);
  if (law.hertzian() || law.bond.normal_stiffness > 0) description.packing.contacts.clear();
  return description;
}

}  // namespace grainlaw::core::test
