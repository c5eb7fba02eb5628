#include "material/contact_keys.hpp"

#include <string>

namespace grainlaw::core {

namespace {

void read_linear(TomlTable& table, ContactLaw& law) {
  table.require_either("young", "kn");
  table.optional("young", number_above(0), law.young);
  table.optional("kn", number_above(0), law.normal_stiffness);
}

void read_hertz(TomlTable& table, ContactLaw& law) {
  law.shear_modulus = table.required("shear_modulus", number_above(0));
  law.poisson = table.required("poisson", number_between(0, 0.5));
  law.ratio = 2 * (1 - law.poisson) / (2 - law.poisson);
}

// Reads two numbers that come together or not at all.
void read_both(TomlTable& table, const std::string& one, double& of_one, const std::string& other,
               double& of_other) {
  table.optional(one, number_above(0), of_one);
  table.optional(other, number_above(0), of_other);
  if (table.has(one) != table.has(other))
    table.fail(table.has(one) ? other : one, "nothing",
               "both of " + one + " and " + other + ", or neither");
}

// Reads rolling resistance, which needs particles that rotate, and tangential forces that rotate
// them.
void read_rolling(TomlTable& contact, ContactLaw& law, long dimension) {
  if (!contact.has("rolling")) return;
  TomlTable table = contact.required_table("rolling");
  law.rolling.ratio = table.required("ratio", number_above(0));
  law.rolling.friction = table.required("friction", number_above(0));
  if (dimension == 3) {
    read_both(table, "twisting_ratio", law.rolling.twisting_ratio, "twisting_friction",
              law.rolling.twisting_friction);
  }
  table.finish();
  if (!law.rotation) contact.fail("rotation", "false", "true with [contact.rolling]");
  if (law.ratio == 0) contact.fail("ratio", "0", "a number > 0 with [contact.rolling]");
  if (law.friction == 0) contact.fail("friction", "0", "a number > 0 with [contact.rolling]");
}

// Reads bending or torsion: stiffness and strength come together, with particles that rotate.
void read_stiff_part(TomlTable& table, const ContactLaw& law, const std::string& part,
                     double& stiffness, double& strength) {
  const std::string of_stiffness = part + "_stiffness", of_strength = part + "_strength";
  table.optional(of_stiffness, number_at_least(0), stiffness);
  table.optional(of_strength, number_above(0), strength);
  if (stiffness > 0 && strength == 0)
    table.fail(of_strength, "nothing", "a number > 0 with " + of_stiffness + " > 0");
  if (stiffness == 0 && strength > 0)
    table.fail(of_strength, "a number", of_stiffness + " > 0 with it");
  if (stiffness > 0 && !law.rotation)
    table.fail(of_stiffness, "a number > 0", "contact.rotation = true with it");
}

void read_bond(TomlTable& contact, ContactLaw& law, long dimension) {
  if (law.ratio == 0) contact.fail("ratio", "0", "a number > 0 with law = \"bonded\"");
  TomlTable table = contact.required_table("bond");
  Bond& bond = law.bond;
  bond.normal_strength = table.required("normal_strength", number_above(0));
  bond.tangential_strength = table.required("tangential_strength", number_above(0));
  read_both(table, "normal_stiffness", bond.normal_stiffness, "tangential_stiffness",
            bond.tangential_stiffness);
  read_stiff_part(table, law, "bending", bond.bending_stiffness, bond.bending_strength);
  if (dimension == 3) {
    read_stiff_part(table, law, "torsion", bond.torsion_stiffness, bond.torsion_strength);
  }
  table.optional("gap", number_at_least(0), bond.gap);
  table.finish();
}

}  // namespace

ContactLaw read_contact(TomlTable table, long dimension) {
  ContactLaw law;
  law.kind = table.required("law", one_of<LawKind>({{"frictional", LawKind::frictional},
                                                    {"compressive", LawKind::compressive},
                                                    {"bonded", LawKind::bonded},
                                                    {"hertz", LawKind::hertz}}));
  if (law.hertzian()) {
    read_hertz(table, law);
  } else {
    read_linear(table, law);
  }
  if (law.kind != LawKind::compressive) {
    if (!law.hertzian()) law.ratio = table.required("ratio", number_at_least(0));
    law.friction = table.required("friction", number_at_least(0));
    table.optional("rotation", boolean(), law.rotation);
    if (law.bonds()) read_bond(table, law, dimension);
    read_rolling(table, law, dimension);
  }
  table.finish();
  return law;
}

}  // namespace grainlaw::core
