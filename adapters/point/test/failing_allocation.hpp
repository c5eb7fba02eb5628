// Memory that runs out once: operator new is defined here, in the program, and so goes before that
// of the C++ library.
#pragma once

namespace grainlaw::test {

// Allocations are counted from now on. The one of this number, from 1, throws; 0: none does.
void fail_allocation(long number);
long allocations();

}  // namespace grainlaw::test
