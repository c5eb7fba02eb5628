// Output files of commands.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// Path directory / name without an extension; creates the directory. Throws InputError when it
// cannot, and for a name that leads elsewhere (is_file_name). Names in scenes are checked earlier,
// at their line.
std::filesystem::path output_stem(const std::string& directory, const std::string& name);

}  // namespace verification
