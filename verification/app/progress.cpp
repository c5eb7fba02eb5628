#include "app/progress.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace verification {
namespace {

constexpr double terminal_interval = 0.2;  // s
constexpr double log_interval = 10;        // s

double seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (terminal_ && shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(double fraction, const std::string& text) {
  const auto now = Clock::now();
  if (seconds(now - last_) < (terminal_ ? terminal_interval : log_interval)) return;
  last_ = now;
  shown_ = true;
  const std::string line = fmt::format("{}: {:3.0f} %, {:.0f} s, {}", what_, 100 * fraction,
                                       seconds(now - start_), text);
  if (terminal_)
    fmt::print(stderr, "\r\033[K{}", line);
  else
    fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

}  // namespace verification
