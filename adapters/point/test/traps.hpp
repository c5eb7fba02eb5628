// A host that gets a signal from invalid operations, divisions by zero and overflows.
#pragma once

#include <cfenv>

namespace grainlaw::test {

#ifdef __GLIBC__
class Traps {
 public:
  Traps() : before_(feenableexcept(all)) {}
  ~Traps() {
    feclearexcept(FE_ALL_EXCEPT);
    fedisableexcept(all);
    feenableexcept(before_);
  }
  Traps(const Traps&) = delete;
  Traps& operator=(const Traps&) = delete;

  // Whether the host still has them.
  [[nodiscard]] static bool there() { return fegetexcept() == all; }

 private:
  static constexpr int all = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
  int before_;
};
#else
struct Traps {
  Traps() {}
  ~Traps() {}
  [[nodiscard]] static bool there() { return true; }
};
#endif

}  // namespace grainlaw::test
