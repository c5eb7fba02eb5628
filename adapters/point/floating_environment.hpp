// The floating-point environment of a call, as inside the library: the adapters, too, compare and
// convert numbers of the host, NaN among them, and a host may trap that.
#pragma once

#include <cfenv>

namespace grainlaw::adapters {

// Default rounding and no traps while this lives; the host's environment is back afterwards.
class FloatingEnvironment {
 public:
  FloatingEnvironment() noexcept {
    std::fegetenv(&host_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatingEnvironment() { std::fesetenv(&host_); }
  FloatingEnvironment(const FloatingEnvironment&) = delete;
  FloatingEnvironment& operator=(const FloatingEnvironment&) = delete;

 private:
  std::fenv_t host_;
};

}  // namespace grainlaw::adapters
