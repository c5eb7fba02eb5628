#include "app/progress.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace verification {
namespace {

constexpr double terminal_interval = 0.2;  // s
constexpr double log_interval = 10;        // s

double seconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

std::string duration(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole < 100) return fmt::format("{} s", whole);
  if (whole < 6000) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

void tell(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (terminal_ && shown_) tell("\r\033[K");
  shown_ = false;
}

void Progress::update(double fraction, const std::string& text) {
  const auto now = Clock::now();
  if (first_fraction_ < 0) {
    first_fraction_ = fraction;
    first_ = now;
  }
  if (seconds(now - last_) < (terminal_ ? terminal_interval : log_interval)) return;
  last_ = now;
  shown_ = true;
  std::string left;
  if (fraction > first_fraction_) {
    const double per_run = seconds(now - first_) / (fraction - first_fraction_);
    left = fmt::format(", {} left", duration((1 - fraction) * per_run));
  }
  const std::string line =
      fmt::format("{}: {:3.0f} %, {}{}{}{}", what_, 100 * fraction, duration(seconds(now - start_)),
                  left, text.empty() ? "" : ", ", text);
  tell(terminal_ ? "\r\033[K" + line : line + "\n");
}

}  // namespace verification
