// Where a command puts its files.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// directory / name, without an extension. Creates the directory. Throws InputError when it cannot, and for
// a name that would lead elsewhere (is_file_name); those of scenes were refused at their line before.
std::filesystem::path output_stem(const std::string& directory, const std::string& name);

}  // namespace verification
