// Files that a command needs for itself alone.
#pragma once

#include <filesystem>
#include <string>

namespace verification {

// A directory of its own below TMPDIR, gone with it. Throws ComputationError.
class ScratchDirectory {
 public:
  ScratchDirectory();
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace verification
