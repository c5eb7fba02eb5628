// One line on stderr that says how far a long run is.
#pragma once

#include <chrono>
#include <string>

namespace verification {

// Writes to stderr; that it cannot be written to ends no run.
void tell(const std::string& text);

// On a terminal the line is rewritten in place; elsewhere a line is printed every few seconds.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Fraction of the run that is done, 0..1, and a short text. The time left is told at the speed
  // since the first call.
  void update(double fraction, const std::string& text);
  // Takes the line off the terminal, to be called before anything else is printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  Clock::time_point first_ = start_;
  double first_fraction_ = -1;
};

}  // namespace verification
