// Allocations that fail on purpose: malloc and its kin, of which operator new and stdio are made,
// for the whole process.
#pragma once

#include <functional>

namespace grainlaw::core::test {

enum class Refuse {
  one,   // memory is there again when the next allocation asks for it
  rest,  // and all that follow, until the call is over
};

struct Allocations {
  long asked = 0;  // by the call
  long kept = 0;   // not given back when it was over
  bool refused = false;
};

// Runs `call` and refuses it the k-th allocation (from 1; 0: none).
Allocations with_refused_allocation(long k, Refuse how, const std::function<void()>& call);

}  // namespace grainlaw::core::test
