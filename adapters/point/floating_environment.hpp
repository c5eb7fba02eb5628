// The floating-point environment of a call, as inside the library: the adapters, too, compare and
// convert numbers of the host, NaN among them, and a host may trap that.
#pragma once

#include <cfenv>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace grainlaw::adapters {

// Default rounding and no traps while this lives; the host's environment is back afterwards.
class FloatingEnvironment {
 public:
  FloatingEnvironment() noexcept {
    if (is_default_) return;
    std::fegetenv(&host_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatingEnvironment() {
    if (!is_default_) std::fesetenv(&host_);
  }
  FloatingEnvironment(const FloatingEnvironment&) = delete;
  FloatingEnvironment& operator=(const FloatingEnvironment&) = delete;

 private:
  // Whether there is nothing to change, where that is cheap to see: to change it takes 0.2 us.
  static bool is_default() noexcept {
#ifdef __SSE2__
    constexpr unsigned traps_masked = 0x1f80, flags = 0x3f;
    return (_mm_getcsr() & ~flags) == traps_masked;
#else
    return false;
#endif
  }

  const bool is_default_ = is_default();
  std::fenv_t host_;
};

}  // namespace grainlaw::adapters
