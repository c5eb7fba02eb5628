// The keys of [packing] that describe a generator.
#pragma once

#include "generate/generator.hpp"
#include "io/toml_table.hpp"

namespace grainlaw::core {

// Every generator has its own keys; one of another generator counts as unknown. Throws Error
// (BAD_MATERIAL). `density` and the thickness are read elsewhere.
GeneratorOptions read_generator(TomlTable& table, long dimension);

}  // namespace grainlaw::core
