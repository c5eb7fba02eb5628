// Whole files, read and written at once: under its name a file is the old one or the new one,
// whenever the process stops or the disk is full. And files that grow by whole pieces.
#pragma once

#include "io/descriptor.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace grainlaw::core {

// Without the mark that spreadsheets begin UTF-8 with. Throws Error (FILE_ERROR) when the file cannot be
// read to its end, and for a pipe or device, which may have none.
std::string read_text(const std::string& path);

struct Writing {
  bool wait = false;  // until the file and its name are on the disk, against a machine that stops
};

// Throws Error (FILE_ERROR) when not all of it could be written; the old file is then as it was, and
// nothing is left beside it. What is no regular file, e.g. /dev/stdout, is written to.
void write_text(const std::string& path, std::string_view text, Writing writing = {});

// Files that belong to each other: all of them are on the disk before the first gets its name. Throws
// as write_text does.
struct TextFile {
  std::string path;
  std::string text;
  std::string first{};  // where it is written before it takes its place, over what a killed process
                        // left there; "": beside it, under a name that nothing has
};
void write_together(std::span<const TextFile> files, Writing writing = {.wait = true});

// Waits until what was written to the file is on the disk. Throws Error (FILE_ERROR).
void sync_file(const std::string& path);

// What cannot be written to the end of its piece leaves nothing of it.
class GrowingFile {
 public:
  // Empty, or with its first `length` bytes. Throw Error (FILE_ERROR), as append() does.
  explicit GrowingFile(const std::string& path);
  GrowingFile(const std::string& path, std::uintmax_t length);

  void append(std::string_view bytes);
  [[nodiscard]] std::uintmax_t length() const { return length_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  Descriptor file_;
  std::uintmax_t length_ = 0;
};

}  // namespace grainlaw::core
