#include "allocator.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>

// What glibc's malloc calls itself, so that the names are free.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

std::atomic<bool> watching{false};
std::atomic<long> asked{0}, kept{0}, first_refused{0}, last_refused{0};

// Counts an allocation; whether it fails.
bool refuse() {
  if (!watching) return false;
  const long k = ++asked;
  if (k < first_refused || k > last_refused) return false;
  errno = ENOMEM;
  return true;
}

void* given(void* memory) {
  if (watching && memory != nullptr) ++kept;
  return memory;
}

}  // namespace

extern "C" {
void* malloc(std::size_t size) { return refuse() ? nullptr : given(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) {
  return refuse() ? nullptr : given(__libc_calloc(count, size));
}
void* realloc(void* memory, std::size_t size) {
  if (refuse()) return nullptr;
  void* const moved = __libc_realloc(memory, size);
  return memory == nullptr ? given(moved) : moved;
}
void* memalign(std::size_t alignment, std::size_t size) {
  return refuse() ? nullptr : given(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  void* const found = memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *memory = found;
  return 0;
}
void free(void* memory) {
  if (watching && memory != nullptr) --kept;
  __libc_free(memory);
}
}

namespace grainlaw::core::test {

Allocations with_refused_allocation(long k, Refuse how, const std::function<void()>& call) {
  asked = kept = 0;
  first_refused = k > 0 ? k : 1;
  last_refused = k <= 0 ? 0 : how == Refuse::one ? k : 1L << 62;
  watching = true;
  call();
  watching = false;
  return {asked, kept, k > 0 && asked >= k};
}

}  // namespace grainlaw::core::test
