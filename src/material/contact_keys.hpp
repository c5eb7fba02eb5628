// The table [contact] of a material file.
#pragma once

#include "contact/law.hpp"
#include "io/toml_table.hpp"

namespace grainlaw::core {

// law = "compressive"  young | kn
//       "frictional"   young | kn, ratio, friction, rotation, [contact.rolling]
//       "bonded"       the same, and [contact.bond]
//       "hertz"        shear_modulus, poisson, friction, rotation, [contact.rolling]
// [contact.rolling]    ratio, friction; of spheres also twisting_ratio, twisting_friction
// [contact.bond]       normal_strength, tangential_strength, bending_stiffness, bending_strength,
//                      gap; of spheres also torsion_stiffness, torsion_strength
// Meaning and units as in ContactLaw. Throws Error (BAD_MATERIAL), also for what cannot act
// together.
ContactLaw read_contact(TomlTable table, long dimension);

}  // namespace grainlaw::core
