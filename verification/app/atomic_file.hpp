// Files that have their old or their new content whenever process or machine stop: those of src/io,
// with errors of the program. Files of others stay (app/own_files.hpp).
#pragma once

#include "io/text_file.hpp"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace verification {

// Writes a temporary file, waits until it is on disk, then renames it. Throws ComputationError with
// the reason; the old file is then unchanged, and no temporary file is left. A target that is no
// regular file, e.g. /dev/stdout, is written in place.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

// Writes files that belong together: all are complete and on disk before the first is renamed.
struct NewFile {
  std::filesystem::path path;
  std::string_view bytes;
};
void write_together(std::initializer_list<NewFile> files);

// write_atomically() without waiting for the disk, for content that can be computed again.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Waits until the file is on disk. Throws ComputationError.
void sync_file(const std::filesystem::path& path);

// A file that grows by whole pieces; a piece that cannot be written completely is removed.
class GrowingFile {
 public:
  // Begins a new file with this text, or keeps the first `length` bytes of the present one.
  // Constructors and append() throw ComputationError.
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
