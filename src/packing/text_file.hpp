// Whole text files, read and written at once.
#pragma once

#include <span>
#include <string>

namespace grainlaw {

// Throws Error (FILE_ERROR) when the file cannot be read to its end, bad_alloc.
std::string read_text(const std::string& path);

struct TextFile {
  std::string path, text;
};

// All files are written beside what was there and then take its place, or none changes: a full disk
// costs nothing. What is no regular file, such as a terminal, is written as it is. Throws as read_text().
void write_texts(std::span<const TextFile> files);

}  // namespace grainlaw
