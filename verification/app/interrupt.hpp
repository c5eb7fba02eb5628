// Ctrl-C and SIGTERM as a request to end soon.
#pragma once

namespace verification {

// Handles signals during its lifetime: the first SIGINT or SIGTERM is recorded and reported. A
// second one ends the process.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // Received signal; 0: none.
  [[nodiscard]] static int signal();
  // Throws Interrupted after a signal.
  static void check();
};

// A run that ended early on request; its text is for the user. The exit code is 128 + signal, as a
// shell counts it.
struct Interrupted {
  int signal;

  [[nodiscard]] const char* text() const;  // name of the signal for the user
};

}  // namespace verification
