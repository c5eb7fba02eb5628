// The edge of the library: no exception, no floating point mode and no cancellation of the host crosses it.
#pragma once

#include <grainlaw/grainlaw.h>

#include <pthread.h>

#include <cfenv>
#include <cstddef>
#include <string_view>
#include <type_traits>

namespace grainlaw::core::api {

// A caller's buffer for one line of text; may be absent. Text is truncated, and always terminated.
struct MessageBuffer {
  char* text = nullptr;
  std::size_t size = 0;
  void write(std::string_view message) const noexcept;
};

// The status of the exception being handled; its text goes to the buffer. Call it in a catch block.
grainlaw_status translate_exception(const MessageBuffer& message) noexcept;

// Default rounding, no floating point traps, no flush to zero while this lives: the result is a
// function of the arguments alone, and a host that traps invalid operations gets no signal from
// here.
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

// Defers cancellation of a thread by the host to the end of the call, since unwinding cannot be
// stopped inside it.
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
