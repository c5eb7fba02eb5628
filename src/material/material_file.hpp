// Material files: TOML in which every key is checked.
#pragma once

#include "io/toml_table.hpp"
#include "material/material.hpp"

#include <string>
#include <string_view>

namespace grainlaw::core {

// Reads a material file and the packing it names; paths in it are relative to its directory. Throws
// Error (FILE_ERROR, BAD_MATERIAL, BAD_PACKING). The message of BAD_MATERIAL is
//   path:line: table.key: found X, expected Y
[[nodiscard]] MaterialDescription read_material_file(const std::string& path);

// Reads a material from text; `name` replaces the path in messages. Keys asked for are appended to
// the log, where given.
[[nodiscard]] MaterialDescription parse_material(std::string_view text,
                                                 const std::string& base_directory,
                                                 const std::string& name, KeyLog* log = nullptr);

}  // namespace grainlaw::core
