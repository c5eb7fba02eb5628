// The [boundary] table of a material file.
#pragma once

#include "boundary/options.hpp"
#include "io/toml_table.hpp"

namespace grainlaw::core {

// Reads the boundary options. Throws Error (BAD_MATERIAL) as TomlTable does.
BoundaryOptions read_boundary(TomlTable table);

}  // namespace grainlaw::core
