#include "material/contact_keys.hpp"

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

// A moment needs discs that turn, and they turn by tangential forces.
void read_rolling(TomlTable& contact, ContactLaw& law) {
  if (!contact.has("rolling")) return;
  TomlTable table = contact.required_table("rolling");
  law.rolling.ratio = table.required("ratio", number_above(0));
  law.rolling.friction = table.required("friction", number_above(0));
  table.finish();
  if (!law.rotation) contact.fail("rotation", "false", "true with [contact.rolling]");
  if (law.ratio == 0) contact.fail("ratio", "0", "a number > 0 with [contact.rolling]");
  if (law.friction == 0) contact.fail("friction", "0", "a number > 0 with [contact.rolling]");
}

void read_bond(TomlTable& contact, ContactLaw& law) {
  if (law.ratio == 0) contact.fail("ratio", "0", "a number > 0 with law = \"bonded\"");
  TomlTable table = contact.required_table("bond");
  Bond& bond = law.bond;
  bond.normal_strength = table.required("normal_strength", number_above(0));
  bond.tangential_strength = table.required("tangential_strength", number_above(0));
  table.optional("bending_stiffness", number_at_least(0), bond.bending_stiffness);
  table.optional("bending_strength", number_above(0), bond.bending_strength);
  table.optional("gap", number_at_least(0), bond.gap);
  table.finish();
  const bool bends = bond.bending_stiffness > 0;
  if (bends && bond.bending_strength == 0)
    table.fail("bending_strength", "nothing", "a number > 0 with bending_stiffness > 0");
  if (!bends && bond.bending_strength > 0)
    table.fail("bending_strength", "a number", "bending_stiffness > 0 with it");
  if (bends && !law.rotation)
    table.fail("bending_stiffness", "a number > 0", "contact.rotation = true with it");
}

}  // namespace

ContactLaw read_contact(TomlTable table) {
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
    if (law.bonds()) read_bond(table, law);
    read_rolling(table, law);
  }
  table.finish();
  return law;
}

}  // namespace grainlaw::core
