// Whole text files, read and written at once: under its name a file is the old one or the new one,
// whenever the process stops or the disk is full.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grainlaw {

// Throws Error (FILE_ERROR) when the file cannot be read to its end.
std::string read_text(const std::string& path);

// Throws Error (FILE_ERROR) when not all of it could be written; the old file is then as it was. What
// is no regular file, e.g. /dev/stdout, is written to.
void write_text(const std::string& path, std::string_view text);

// Files that belong to each other: all of them are on the disk before the first gets its name. Throws
// as write_text does.
struct TextFile {
  std::string path;
  std::string text;
};
void write_together(std::span<const TextFile> files);

}  // namespace grainlaw
