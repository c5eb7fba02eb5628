// Where a command puts its files.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// directory / name, without an extension. Creates the directory. Throws InputError when it cannot.
std::filesystem::path output_stem(const std::string& directory, const std::string& name);

}  // namespace verification
