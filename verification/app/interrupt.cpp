#include "app/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <initializer_list>
#include <string_view>

namespace verification {
namespace {

volatile std::sig_atomic_t received = 0;

extern "C" void note(int number) {
  received = number;
  constexpr std::string_view told = "\ngrainlaw: ends after this step; once more ends it at once\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, told.data(), told.size());
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void handle(void (*handler)(int)) {
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
  }
}

}  // namespace

Interrupt::Interrupt() {
  received = 0;
  handle(note);
}

Interrupt::~Interrupt() {
  handle(SIG_DFL);
  received = 0;
}

int Interrupt::signal() { return received; }

void Interrupt::check() {
  if (received != 0) throw Interrupted{received};
}

const char* Interrupted::text() const {
  return signal == SIGINT ? "stopped by Ctrl-C (SIGINT)" : "stopped by SIGTERM";
}

}  // namespace verification
