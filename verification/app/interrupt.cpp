#include "app/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace verification {
namespace {

volatile std::sig_atomic_t received = 0;

extern "C" void note(int number) {
  received = number;
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

Interrupt::~Interrupt() { handle(SIG_DFL); }

int Interrupt::signal() { return received; }

}  // namespace verification
