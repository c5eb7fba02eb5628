// A material description with another packing.
#pragma once

#include "app/material.hpp"

namespace verification {

// The same with the packing in prefix_particles.csv, _contacts.csv and _cell.csv in place of its own,
// so that nothing of that is left. Throws InputError.
MaterialSource with_packing(const MaterialSource& source, const std::filesystem::path& prefix);

}  // namespace verification
