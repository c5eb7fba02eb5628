// A material description with another packing.
#pragma once

#include "app/material.hpp"

namespace verification {

// Replaces the packing of a source, with all its keys, by prefix_particles.csv, _contacts.csv and
// _cell.csv. Throws InputError.
MaterialSource with_packing(const MaterialSource& source, const std::filesystem::path& prefix);

}  // namespace verification
