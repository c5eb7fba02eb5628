// One line on stderr that says how far a long run is.
#pragma once

#include <chrono>
#include <string>

namespace verification {

// On a terminal the line is rewritten in place; elsewhere a line is printed every few seconds.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // fraction of the run that is done, 0..1, and a short text
  void update(double fraction, const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace verification
