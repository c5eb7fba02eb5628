#include "failing_allocation.hpp"

#include <cstdlib>
#include <new>

namespace {

long counted = 0, failing = 0;

}  // namespace

namespace grainlaw::test {

void fail_allocation(long number) {
  counted = 0;
  failing = number;
}

long allocations() { return counted; }

}  // namespace grainlaw::test

void* operator new(std::size_t size) {
  if (++counted == failing) throw std::bad_alloc();
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
