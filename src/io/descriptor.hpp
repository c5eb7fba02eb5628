// A file descriptor with an owner.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace grainlaw::core {

// Throws Error (FILE_ERROR) "path: cannot be WHAT: reason", or std::bad_alloc when memory is short.
[[noreturn]] void fail_file(const std::string& path, const char* what, int error);

// An open file, closed by the destructor.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags);
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool valid() const { return number_ >= 0; }
  [[nodiscard]] bool streams() const;  // a pipe or device, which may be endless
  [[nodiscard]] ssize_t read(char* to, std::size_t size) const;
  // Each call returns 0 or errno.
  int write(std::string_view text);
  int keep_mode(mode_t mode);
  int sync();  // unsupported by the file system: counts as done
  int cut(std::uintmax_t length);
  int close();

 private:
  int number_;
};

}  // namespace grainlaw::core
