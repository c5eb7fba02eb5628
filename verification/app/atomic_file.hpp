// Files that are either the old ones or the whole new ones, whenever the process or the machine
// stops: those of src/io, with errors of the program. Files of others stay (app/own_files.hpp).
#pragma once

#include "io/text_file.hpp"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace verification {

// Writes beside the file, waits until it is on the disk, then renames. Throws ComputationError with
// the reason; the old file is then as it was, and nothing is left beside it. What is no regular file,
// e.g. /dev/stdout, is written to.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

// Files that belong to each other: all are whole and on the disk before the first gets its name.
struct NewFile {
  std::filesystem::path path;
  std::string_view bytes;
};
void write_together(std::initializer_list<NewFile> files);

// As write_atomically without waiting for the disk, for what can be written again when the machine stopped.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Waits until what was written to the file is on the disk. Throws ComputationError.
void sync_file(const std::filesystem::path& path);

// A file that grows by whole pieces: what cannot be written to its end leaves nothing of itself.
class GrowingFile {
 public:
  // A new file with this beginning, or what is there with its first `length` bytes alone. Throw
  // ComputationError, as append() does.
  GrowingFile(const std::filesystem::path& path, std::string_view beginning);
  GrowingFile(const std::filesystem::path& path, std::uintmax_t length);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void append(std::string_view bytes);
  [[nodiscard]] std::uintmax_t length() const { return file_.length(); }
  [[nodiscard]] std::filesystem::path path() const { return file_.path(); }

 private:
  grainlaw::core::GrowingFile file_;
};

}  // namespace verification
