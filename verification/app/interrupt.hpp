// Ctrl-C and SIGTERM as a wish to end soon.
#pragma once

namespace verification {

// While it lives, the first SIGINT or SIGTERM is noted; a second one ends the process at once, as
// both do without it.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // The signal that has come, 0: none.
  [[nodiscard]] static int signal();
};

// A run that ended early because it was asked to; what it says is for the user. The command ends
// with exit code 128 + signal, as a shell counts it.
struct Interrupted {
  int signal;
};

}  // namespace verification
