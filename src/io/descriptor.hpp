// An open file of the system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace grainlaw::core {

// Throws Error (FILE_ERROR) "path: cannot be WHAT: reason", or std::bad_alloc for a lack of memory.
[[noreturn]] void fail_file(const std::string& path, const char* what, int error);

// Closed when it goes.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags);
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool valid() const { return number_ >= 0; }
  [[nodiscard]] bool streams() const;  // a pipe or device: without an end, perhaps
  [[nodiscard]] ssize_t read(char* to, std::size_t size) const;
  // Each returns 0, or the error.
  int write(std::string_view text);
  int keep_mode(mode_t mode);
  int sync();  // what the file system cannot do counts as done
  int cut(std::uintmax_t length);
  int close();

 private:
  int number_;
};

}  // namespace grainlaw::core
