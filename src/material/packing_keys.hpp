// The keys of [packing] that describe a generator.
#pragma once

#include "generate/generator.hpp"
#include "io/toml_table.hpp"

namespace grainlaw::core {

// Reads the options of a generator; a key of another generator is unknown. `density` and the
// thickness are read elsewhere. Throws Error (BAD_MATERIAL).
GeneratorOptions read_generator(TomlTable& table, long dimension);

}  // namespace grainlaw::core
