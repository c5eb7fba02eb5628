#include "failing_calls.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>

namespace grainlaw::test {
namespace {

int counted = 0, failing = 0;

bool fails(int error) {
  if (++counted != failing) return false;
  errno = error;
  return true;
}

}  // namespace

void fail_call(int number) {
  counted = 0;
  failing = number;
}

int calls() { return counted; }

}  // namespace grainlaw::test

using grainlaw::test::fails;

extern "C" {

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
  }
  if (fails(ENOSPC)) return -1;
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

// A full disk takes a part first.
ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (fails(ENOSPC)) return -1;
  return syscall(SYS_write, descriptor, bytes, size > 1 ? size / 2 : size);
}

int fsync(int descriptor) {
  if (fails(EIO)) return -1;
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}

int close(int descriptor) {
  const int result = static_cast<int>(syscall(SYS_close, descriptor));
  return fails(EIO) ? -1 : result;
}

int rename(const char* from, const char* to) noexcept {
  if (fails(ENOSPC)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

}  // extern "C"
