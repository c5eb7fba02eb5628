#include "io/descriptor.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

namespace grainlaw::core {

void fail_file(const std::string& path, const char* what, int error) {
  if (error == ENOMEM) throw std::bad_alloc();
  throw Error(GRAINLAW_FILE_ERROR,
              fmt::format("{}: cannot be {}: {}", path, what, std::strerror(error)));
}

// Opens without blocking: a pipe without a peer would block the host for ever.
Descriptor::Descriptor(const std::string& path, int flags)
    : number_(::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0666)) {
  if (valid()) ::fcntl(number_, F_SETFL, flags & O_APPEND);
}

bool Descriptor::streams() const {
  struct stat found {};
  return ::fstat(number_, &found) == 0 && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode);
}

ssize_t Descriptor::read(char* to, std::size_t size) const {
  for (;;) {
    const ssize_t count = ::read(number_, to, size);
    if (count >= 0 || errno != EINTR) return count;
  }
}

int Descriptor::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(number_, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

int Descriptor::keep_mode(mode_t mode) { return ::fchmod(number_, mode) == 0 ? 0 : errno; }

int Descriptor::sync() {
  const bool done = ::fsync(number_) == 0;
  return done || errno == EINVAL || errno == ENOSYS ? 0 : errno;
}

int Descriptor::cut(std::uintmax_t length) {
  const auto end = static_cast<off_t>(length);
  return ::ftruncate(number_, end) == 0 && ::lseek(number_, end, SEEK_SET) == end ? 0 : errno;
}

int Descriptor::close() {
  const int result = number_ < 0 || ::close(number_) == 0 ? 0 : errno;
  number_ = -1;
  return result;
}

}  // namespace grainlaw::core
