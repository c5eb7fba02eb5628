// The table [contact] of a material file.
#pragma once

#include "contact/law.hpp"
#include "io/toml_table.hpp"

namespace grainlaw::core {

// Reads the contact law. Meaning and units as in ContactLaw.
//   law = "compressive"  young | kn;
//         "frictional"   young | kn, ratio, friction, rotation, [contact.rolling];
//         "bonded"       those of "frictional", and [contact.bond];
//         "hertz"        shear_modulus, poisson, friction, rotation, [contact.rolling];
//   [contact.rolling]    ratio, friction; of spheres also twisting_ratio, twisting_friction;
//   [contact.bond]       normal_strength, tangential_strength, normal_stiffness,
//                        tangential_stiffness, bending_stiffness, bending_strength, gap;
//                        of spheres also torsion_stiffness, torsion_strength.
// Throws Error (BAD_MATERIAL), also for keys that exclude each other.
ContactLaw read_contact(TomlTable table, long dimension);

}  // namespace grainlaw::core
