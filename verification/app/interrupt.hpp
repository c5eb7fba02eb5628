// Ctrl-C and SIGTERM as a wish to end soon.
#pragma once

namespace verification {

// While it lives, the first SIGINT or SIGTERM is noted, and the user told; a second one ends the
// process at once, as both do without it.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // The signal that has come, 0: none.
  [[nodiscard]] static int signal();
  // Throws Interrupted when one has come.
  static void check();
};

// A run that ended early because it was asked to; what it says is for the user. The command ends
// with exit code 128 + signal, as a shell counts it.
struct Interrupted {
  int signal;

  [[nodiscard]] const char* text() const;  // for the user: by what it was stopped
};

}  // namespace verification
