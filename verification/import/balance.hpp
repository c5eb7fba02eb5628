// Whether contact forces hold each other on every particle, and on which of the two they act.
#pragma once

#include "import/foreign_packing.hpp"
#include "import/source_table.hpp"

namespace verification {

// The mean force left on a particle over the mean force of a contact [-], with tangential forces
// `sign` times as they are. Particles at the walls of a box are left out.
double force_left(const ForeignPacking& packing, double sign);

// Turns tangential forces and moments to act on j, by the balance of forces; where both ways balance
// alike they act on j, in files of LAMMPS on i. Throws where neither balances.
void settle_signs(const SourceTable& table, bool parted, ForeignPacking& packing);

}  // namespace verification
