// Guards of the library's boundary: exceptions, floating point modes and cancellation do not cross
// it.
#pragma once

#include <grainlaw/grainlaw.h>

#include <pthread.h>

#include <cfenv>
#include <cstddef>
#include <string_view>
#include <type_traits>

namespace grainlaw::core::api {

// The caller's buffer for one line of text, may be absent. Text is truncated and always terminated.
struct MessageBuffer {
  char* text = nullptr;
  std::size_t size = 0;
  void write(std::string_view message) const noexcept;
};

// Translates the exception being handled into a status, with its text in the buffer. Call it in a
// catch block.
grainlaw_status translate_exception(const MessageBuffer& message) noexcept;

// Sets default rounding, no floating point traps and no flush to zero during its lifetime. Results
// then depend on the arguments alone, and a host that traps invalid operations receives no signal.
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

// Disables cancellation of the thread until the call returns. Cancellation unwinds the stack, which
// must not cross a C interface.
class CancellationOff {
 public:
  CancellationOff() noexcept { pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &host_); }
  ~CancellationOff() { pthread_setcancelstate(host_, nullptr); }
  CancellationOff(const CancellationOff&) = delete;
  CancellationOff& operator=(const CancellationOff&) = delete;

 private:
  int host_ = PTHREAD_CANCEL_ENABLE;
};

// Runs the body of an entry point: a callable that returns a status, or nothing for OK.
template <class Body>
grainlaw_status guarded(Body&& body, const MessageBuffer& message = {}) noexcept {
  const CancellationOff cancellation;
  const FloatingEnvironment environment;
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<Body>>) {
      body();
      return GRAINLAW_OK;
    } else {
      return body();
    }
  } catch (...) {
    return translate_exception(message);
  }
}

}  // namespace grainlaw::core::api
