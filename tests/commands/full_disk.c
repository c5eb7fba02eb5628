/* Preloaded: from its GRAINLAW_WRITES-th write to a file on, the disk is full. A write that fails has
 * put half of its bytes there; closing, waiting for the disk and memory are as ever. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static int full(int file) {
  static long writes = 0;
  static long limit = -1;
  struct stat status;
  if (limit < 0) {
    const char* text = getenv("GRAINLAW_WRITES");
    limit = text != NULL ? atol(text) : __LONG_MAX__;
  }
  /* Files in memory have no name. */
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink == 0) return 0;
  return __atomic_fetch_add(&writes, 1, __ATOMIC_RELAXED) >= limit;
}

ssize_t write(int file, const void* bytes, size_t count) {
  static ssize_t (*really)(int, const void*, size_t) = NULL;
  if (really == NULL) *(void**)&really = dlsym(RTLD_NEXT, "write");
  if (!full(file)) return really(file, bytes, count);
  if (count > 1) really(file, bytes, count / 2);
  errno = ENOSPC;
  return -1;
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  static ssize_t (*really)(int, const struct iovec*, int) = NULL;
  if (really == NULL) *(void**)&really = dlsym(RTLD_NEXT, "writev");
  if (!full(file)) return really(file, parts, count);
  if (count > 1) really(file, parts, 1);
  errno = ENOSPC;
  return -1;
}
