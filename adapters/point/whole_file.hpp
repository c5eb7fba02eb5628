// A file that is either the old one or the whole new one, whatever a write meets.
#pragma once

#include <cstddef>
#include <string>

namespace grainlaw::adapters {

// What is written lies beside the file until it is on the disk, and then takes its place. Every
// function throws std::runtime_error with path and reason, and raises no signal; the file is then
// as it was, and nothing is left beside it. A device or a pipe is written to as it is.
class WholeFile {
 public:
  explicit WholeFile(const std::string& path);
  ~WholeFile();  // unless kept, drops what was written
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(const void* bytes, std::size_t size);
  // What was written so far is the file.
  void keep();

 private:
  void flush();
  void close();

  std::string path_, target_;  // as named, and behind links
  std::string temporary_;      // empty: written in place
  std::string buffer_;
  int descriptor_ = -1;
};

}  // namespace grainlaw::adapters
