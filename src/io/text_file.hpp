// Whole files, replaced atomically: a file has its old or its new content, whenever the process
// stops or the disk is full. Growing files gain whole pieces.
#pragma once

#include "io/descriptor.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace grainlaw::core {

// Content without a UTF-8 byte order mark. Throws Error (FILE_ERROR) when the file cannot be read
// to its end, and for a pipe or device.
std::string read_text(const std::string& path);

struct Writing {
  bool wait = false;  // until file and name are on disk, safe against power loss
};

// Throws Error (FILE_ERROR) when writing fails; the old file is then unchanged, and no temporary
// file is left. A target that is no regular file, e.g. /dev/stdout, is written in place.
void write_text(const std::string& path, std::string_view text, Writing writing = {});

// Writes files that belong together: all are on disk before the first is renamed. Throws as
// write_text does.
struct TextFile {
  std::string path;
  std::string text;
  std::string first{};  // where it is written before it takes its place, over what a killed process
                        // left there; "": beside it, under a name that nothing has
};
void write_together(std::span<const TextFile> files, Writing writing = {.wait = true});

// Waits until the file is on disk. Throws Error (FILE_ERROR).
void sync_file(const std::string& path);

// A file that grows by whole pieces; a piece that cannot be written completely is removed.
class GrowingFile {
 public:
  // Opens the file empty, or with its first `length` bytes. Constructors and append() throw Error
  // (FILE_ERROR).
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
