// Whole text files, read and written at once.
#pragma once

#include <string>
#include <string_view>

namespace grainlaw {

// Throws Error (FILE_ERROR) when the file cannot be read to its end.
std::string read_text(const std::string& path);

// Throws Error (FILE_ERROR) when not all of it could be written.
void write_text(const std::string& path, std::string_view text);

}  // namespace grainlaw
